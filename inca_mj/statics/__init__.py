"""Statics of the eight cables: what they hold, how stiffly and where, and what their mass costs."""
