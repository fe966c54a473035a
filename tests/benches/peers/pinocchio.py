"""Least processor time per call of Pinocchio: a line `# how`, then case, tab, nanoseconds. Run in the folder of the tests.

In C++ where the package carries its headers and a compiler and Eigen are there (`CXX`, `EIGEN`: the folder with `Eigen/Core`), else from Python.
"""

import hashlib
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import pinocchio as pin

SOURCE = Path("benches/peers/pinocchio.cpp")
FLAGS = ["-std=c++17", "-O3", "-march=native", "-DNDEBUG"]
# as the package itself is built
LIMITS = ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", "-DBOOST_FUSION_INVOKE_MAX_ARITY=10"]


def tree(path):
    # the reference states give continuous joints one angle, not sine and cosine
    text = open(path).read().replace('type="continuous">', 'type="revolute"><limit lower="-9" upper="9" effort="1" velocity="1"/>')
    return pin.buildModelFromXML(text, pin.JointModelFreeFlyer())


def compiled():
    """The program in C++ and how it was made; `None` where something is missing."""
    compiler = os.environ.get("CXX") or shutil.which("clang++") or shutil.which("g++")
    eigen = os.environ.get("EIGEN", "/usr/include/eigen3")
    prefix = next((p for p in Path(pin.__file__).parents if (p / "include/pinocchio").is_dir()), None)
    if not (compiler and prefix and Path(eigen, "Eigen/Core").exists()):
        return None
    how = f"Pinocchio {pin.__version__} in C++, {Path(compiler).name} {' '.join(FLAGS[1:3])}"
    key = hashlib.sha256((how + str(prefix) + SOURCE.read_text()).encode()).hexdigest()[:12]
    program = Path(tempfile.gettempdir(), f"fastbike_pinocchio_{key}")
    if not program.exists():
        libraries = [f"-L{prefix}/lib", f"-Wl,-rpath,{prefix}/lib", "-lpinocchio_default", "-lboost_serialization"]
        includes = [f"-I{prefix}/include", f"-I{eigen}"]
        command = [compiler, *FLAGS, *LIMITS, *includes, str(SOURCE), "-o", str(program), *libraries]
        if subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
            return None
    return how, program


def least(call):
    best = float("inf")
    for _ in range(60):
        start = time.thread_time_ns()
        for _ in range(1000):
            call()
        best = min(best, (time.thread_time_ns() - start) / 1000)
    return best


models = {"moto11": tree("reference/moto11/moto11_free.urdf"), "tree38": tree("../models/mechanisms/tree38/tree38.urdf")}
made = compiled()
if made:
    print(f"# {made[0]}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        arguments = []
        for name, model in models.items():
            model.saveToText(f"{folder}/{name}.txt")
            arguments += [name, f"{folder}/{name}.txt"]
        subprocess.run([made[1], *arguments], check=True)
else:
    print(f"# Pinocchio {pin.__version__} called from Python; an empty call costs part of it", flush=True)
    for name, model in models.items():
        data = model.createData()
        q, v, a, tau = pin.neutral(model), np.ones(model.nv), np.ones(model.nv), np.ones(model.nv)
        q[7:] = 0.3
        print(f"empty call\t{least(lambda: pin.Force.Zero)}")
        print(f"rnea {name}\t{least(lambda: pin.rnea(model, data, q, v, a))}")
        print(f"aba {name}\t{least(lambda: pin.aba(model, data, q, v, tau))}")
        print(f"crba {name}\t{least(lambda: pin.crba(model, data, q))}")
        print(f"drnea {name}\t{least(lambda: pin.computeRNEADerivatives(model, data, q, v, a))}")
