"""Same seed, same bits, whatever torch is set to outside."""

from collections.abc import Iterator
from contextlib import contextmanager

import torch


@contextmanager
def one_thread() -> Iterator[None]:
    """Torch on one thread with deterministic algorithms; what was set before is set again."""
    threads = torch.get_num_threads()
    strict = torch.get_deterministic_debug_mode()
    torch.set_num_threads(1)
    # `use_deterministic_algorithms` does the same, and opens torch's compiler for seconds first.
    torch.set_deterministic_debug_mode("error")
    try:
        yield
    finally:
        torch.set_num_threads(threads)
        torch.set_deterministic_debug_mode(strict)
