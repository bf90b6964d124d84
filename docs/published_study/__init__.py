"""The parts of `make_published_study.py`: problems, runs, comparison with the tables, pictures, page.

One thread: CPU times are told. This must be said before NumPy is loaded.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
