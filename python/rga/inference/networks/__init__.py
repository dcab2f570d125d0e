"""Networks that infer contexts, trained adversarially and guided by physics (torch)."""
