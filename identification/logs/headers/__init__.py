"""Headers of the columns of a log: names, units, and what a column looks like."""
