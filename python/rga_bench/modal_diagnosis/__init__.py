"""The blind challenge with measured modes, alone and beside a record of gauges."""
