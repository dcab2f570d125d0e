"""Pictures of the pages: drawn by the server, in colours that the style sheet chooses."""
