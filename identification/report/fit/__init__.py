"""The report of a fit: verdict, headline, values, and its JSON."""
