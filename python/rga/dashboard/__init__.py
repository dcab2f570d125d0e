"""What people and programs see of a service: its API and its pages."""
