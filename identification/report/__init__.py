"""Results as text, figures and one-file reports, for any robot."""
