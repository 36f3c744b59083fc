"""Time stamps of a log, and the even grid on which its rows are put."""
