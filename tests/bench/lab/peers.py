"""peers.py LOGS.json ANSWERS.json TRACTION - PySINDy (STLSQ) and SysIdentPy (FROLS) asked the lab's question: which effect is missing?

Both regress; neither knows a rover. Their best honest use is to hand them what the lab has before it decides: the residuals of the
fitted baseline and the sensitivities of every candidate (`traction export --regressors`), prepared as regression.py says. What is
left to them is theirs: which columns, and how many. The terms are counted by BIC with an effective sample size, because ground noise
stays correlated after whitening; FROLS also by plain BIC. Seconds are those of one log from its file to the answer, on one core.
"""
import json
import os
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np
from pysindy.optimizers import STLSQ
from regression import regression
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS
from sysidentpy.parameter_estimation import LeastSquares

warnings.filterwarnings("ignore")
ROWS_A_SAMPLE = 8  # rows that count as one independent sample; chosen like regression.py's numbers
MOST_TERMS = 10
RIDGE = 10.0  # of columns of unit norm: nearly parallel ones must not grow against each other in the first, full fit
THRESHOLDS = np.geomspace(0.05, 4, 14)  # in units of a standard deviation / (1 + ridge)


def criterion(squares, terms, rows, rows_a_sample):
    n = rows / rows_a_sample
    return n * np.log(squares / n) + terms * np.log(n)


def named(order, effects):
    """The effects of these columns, each once: several shapes or wheels of one effect are one name."""
    return list(dict.fromkeys(effects[k] for k in order))


def stlsq(Y, X):
    """The threshold of the best criterion, no term at all included; strongest term first."""
    triangle = np.linalg.qr(np.column_stack([X, Y]), mode="r")  # the same normal equations in fewer rows
    A, b = triangle[:, :-1], triangle[:, -1]
    best, order = criterion(Y @ Y, 0, len(Y), ROWS_A_SAMPLE), []
    for threshold in THRESHOLDS:
        model = STLSQ(threshold=threshold, alpha=RIDGE, max_iter=50)
        model.fit(A, b[:, None])
        c = np.ravel(model.coef_)
        score = criterion(np.sum((b - A @ c) ** 2), np.count_nonzero(c), len(Y), ROWS_A_SAMPLE)
        if np.any(c) and score < best:
            best, order = score, [k for k in np.argsort(-np.abs(c)) if c[k] != 0]
    return order


def frols(Y, X):
    """The order of the columns by error reduction ratio, and the ratios."""
    model = FROLS(order_selection=False, n_terms=MOST_TERMS, estimator=LeastSquares(), model_type="NFIR",
                  xlag=[[1]] * X.shape[1], basis_function=Polynomial(degree=1))
    model.fit(X=np.vstack([X, X[-1:]]), y=np.append(0, Y)[:, None])  # lag 1 pairs y[k] with x[k - 1]
    code = np.asarray(model.final_model)[:, 0]  # 2001: the first column; 0: the constant
    return [int(c // 1000) - 2 for c in code], np.asarray(model.err)[:MOST_TERMS]


def cut(order, ratios, Y, rows_a_sample):
    """As many of FROLS's terms as the criterion wants, perhaps none."""
    left = Y @ Y * (1 - np.append(0, np.cumsum(ratios)))
    scores = [criterion(squares, k, len(Y), rows_a_sample) for k, squares in enumerate(left)]
    return [k for k in order[: int(np.argmin(scores))] if k >= 0]


def main():
    with open(sys.argv[1]) as file:
        logs = json.load(file)
    prepared = "the lab's residuals and sensitivities, whitened, the baseline projected out; "
    peers = {
        "PySINDy STLSQ": {"use": prepared + "threshold by BIC of the effective sample size"},
        "SysIdentPy FROLS": {"use": prepared + "order by BIC of the effective sample size"},
        "SysIdentPy FROLS, plain BIC": {"use": prepared + "order by BIC"},
    }
    for peer in peers.values():
        peer["answers"], peer["seconds"] = [], []

    def note(name, order, effects, seconds):
        peers[name]["answers"].append(named(order, effects))
        peers[name]["seconds"].append(seconds)

    for log in logs:
        start = time.time()
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "regressors")
            subprocess.run([sys.argv[3], "export", "--model", log["model"], "--log", log["log"], "--regressors", file], check=True, stdout=subprocess.DEVNULL)
            Y, X, effects = regression(file)
        ready = time.time()
        terms = stlsq(Y, X)
        note("PySINDy STLSQ", terms, effects, time.time() - start)
        shared, start = ready - start, time.time()
        order, ratios = frols(Y, X)
        seconds = shared + time.time() - start
        note("SysIdentPy FROLS", cut(order, ratios, Y, ROWS_A_SAMPLE), effects, seconds)
        note("SysIdentPy FROLS, plain BIC", cut(order, ratios, Y, 1), effects, seconds)
    with open(sys.argv[2], "w") as file:
        json.dump({"peers": peers}, file, indent=1)


if __name__ == "__main__":
    main()
