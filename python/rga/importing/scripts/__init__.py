"""Scripts that are read without running them: values that are known, and those that are not."""
