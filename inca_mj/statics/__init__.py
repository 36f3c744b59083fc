"""What the eight cables can hold, how stiffly and where, and what their mass costs."""
