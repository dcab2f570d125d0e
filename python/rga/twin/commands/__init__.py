"""What people ask a twin for: the commands, the desk that carries them out, readings out of use."""
