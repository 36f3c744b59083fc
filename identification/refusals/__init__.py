"""Checks of a log against its robot: units, signs, places, contacts, joints without a sensor."""
