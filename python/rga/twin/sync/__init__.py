"""Is the twin in sync with the structure, and when is it brought into sync again?"""
