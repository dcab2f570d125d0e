"""Alarms: what is wrong, who knows of it, and until when nobody wants to hear of it."""
