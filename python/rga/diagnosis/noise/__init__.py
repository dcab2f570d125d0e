"""How readings scatter about a faultless simulation: noise, contexts' errors, as-built scatter."""
