"""Who may see and do what: users, their sessions, tokens of programs, and what guards them."""
