"""Least processor time per call of Pinocchio from Python: case, tab, nanoseconds. Run in the folder of the tests."""

import time

import numpy as np
import pinocchio as pin


def tree(path):
    # the reference states give continuous joints one angle, not sine and cosine
    text = open(path).read().replace('type="continuous">', 'type="revolute"><limit lower="-9" upper="9" effort="1" velocity="1"/>')
    return pin.buildModelFromXML(text, pin.JointModelFreeFlyer())


def least(call):
    best = float("inf")
    for _ in range(60):
        start = time.thread_time_ns()
        for _ in range(1000):
            call()
        best = min(best, (time.thread_time_ns() - start) / 1000)
    return best


for name, path in (("moto11", "reference/moto11/moto11_free.urdf"), ("tree38", "../models/mechanisms/tree38/tree38.urdf")):
    model = tree(path)
    data = model.createData()
    q, v, a, tau = pin.neutral(model), np.ones(model.nv), np.ones(model.nv), np.ones(model.nv)
    q[7:] = 0.3
    print(f"empty call\t{least(lambda: pin.Force.Zero)}")
    print(f"rnea {name}\t{least(lambda: pin.rnea(model, data, q, v, a))}")
    print(f"aba {name}\t{least(lambda: pin.aba(model, data, q, v, tau))}")
    print(f"crba {name}\t{least(lambda: pin.crba(model, data, q))}")
    print(f"drnea {name}\t{least(lambda: pin.computeRNEADerivatives(model, data, q, v, a))}")
