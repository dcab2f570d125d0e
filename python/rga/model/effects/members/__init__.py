"""Members: how stiff they are, and what carries along with them."""
