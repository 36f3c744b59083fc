"""The running program: its processes, threads, memory, imports, compiled code and progress."""
