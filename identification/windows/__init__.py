"""Windows of a log, whose initial states are nuisances: fits and errors of prediction over them."""
