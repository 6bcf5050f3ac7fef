"""Errors of a trajectory against the truth. The numbers equal evo's.

>>> import numpy as np
>>> t = np.linspace(0, 6, 61)
>>> zero, one = np.zeros_like(t), np.ones_like(t)
>>> truth = np.column_stack([t, np.cos(t), np.sin(t), zero, zero, zero, zero, one])
>>> moved = truth.copy()
>>> moved[:, 3] += 0.5
>>> round(trundle.evaluate.ate(truth, moved, align="none")["rmse"], 9)
0.5
>>> trundle.evaluate.ate(truth, moved)["rmse"] < 1e-12
True
"""

from ._native import ate, rpe

__all__ = ["ate", "rpe"]
