"""Many tasks of one kind, on one machine or many: methods, tasks, records, and what they come to.

A *method* is a function of settings and a seed that returns one record. A *sweep* is a TOML that
says which methods run with which settings, and how often. Its *tasks* are plain data, so that a
*backend* may run them anywhere and in any order; the records are the same to the bit. They are kept
as Parquet as each task ends.
"""
