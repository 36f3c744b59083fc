"""The report of a discovery: verdict, sections, figures, and its JSON."""
