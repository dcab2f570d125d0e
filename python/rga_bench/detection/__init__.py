"""How soon a change is seen, at which rate of false alarms: detectors beside the optimum."""
