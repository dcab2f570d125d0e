"""`python -m rga_bench.samples DIR`: the archives of the samples, made anew."""

import sys
from pathlib import Path

from rga_bench.samples.make import make_samples

if __name__ == "__main__":
    make_samples(Path(sys.argv[1]))
