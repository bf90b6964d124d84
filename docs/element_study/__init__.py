"""The parts of `make_element_study.py`: cases, runs, convergence, candidates, tables, pictures.

One thread: CPU times are compared. This must be said before NumPy is loaded.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
