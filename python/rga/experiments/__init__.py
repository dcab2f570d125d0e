"""What could be measured on a structure, and how far it separates two explanations."""
