"""Methods on the logs of any robot, by their names in the TOML of a sweep."""

METHODS = {
    "fit-log": "identification.sweep.methods.fit_log:FIT_LOG",
    "discover-log": "identification.sweep.methods.discover_log:DISCOVER_LOG",
}
