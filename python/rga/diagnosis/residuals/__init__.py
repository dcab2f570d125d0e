"""What the causes leave: patterns, nonlinear responses, channels that do not fit."""
