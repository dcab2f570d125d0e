"""Detection: is the twin still in sync with the structure?"""

from rga._core import GaussianWindow

__all__ = ["GaussianWindow"]
