"""Notices of alarms: kept until they have arrived."""
