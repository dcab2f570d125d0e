"""`rga benchmark endless`: what a row costs a twin that has run for long."""
