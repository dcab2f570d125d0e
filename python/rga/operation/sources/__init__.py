"""Where packets come from, and what is looked at before they are kept."""
