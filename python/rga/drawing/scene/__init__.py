"""What there is to draw of a model: places and directions in metres, without any look."""
