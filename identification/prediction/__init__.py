"""Evidence by prediction: windows of several records, whose states are nuisances."""
