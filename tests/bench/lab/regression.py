"""regression.py - the regression that both peers are given, from `traction export --regressors`.

The file holds the fitted baseline's residuals on the lab's own scales, what each of the baseline's parameters changes in them, and
what each candidate effect (on all wheels, on one, in each shape) changes. What follows is what an expert user would do with them
before any sparse regression: rows thinned and whitened, what the baseline can absorb projected out, columns of unit norm.
"""
import json

import numpy as np
from scipy.linalg import solve_toeplitz

# Chosen on logs of seeds 30000 to 30059, for what the peers name right first.
BIN_S = 0.2  # quicker noise counts once
LAGS = 3     # of the residual's own past that are taken out (prewhitening): right first 0.67 -> 0.77
HUBER = 1.3  # squared residuals up to here, absolute beyond: jerks must not rule
PATCH_M = (1.0,)  # one length of soil patch: a hundred patches find a patch in any uneven ground


def read(path):
    """Time, balance and residual of each row, the baseline's columns, the candidates' columns, and their descriptions."""
    with open(path, "rb") as file:
        head = json.loads(file.readline())
        table = np.fromfile(file, "<f4").reshape(-1, head["rows"])
    about, columns = head["columns"], table[3:]
    own = [k for k, c in enumerate(about) if "own" in c]
    tried = [k for k, c in enumerate(about) if c.get("effect") and c["shape"].get("length_m", PATCH_M[0]) in PATCH_M]
    stacked = np.column_stack([table[2], columns[own].T, columns[tried].T]).astype(float)
    return table[0], table[1].astype(int), stacked, [about[k] for k in own], [about[k]["effect"] for k in tried]


def thinned(time, balance, columns):
    """Sums over bins of each balance, divided by the root of the rows they hold; with their times and balances."""
    bins = np.floor((time - time.min()) / BIN_S).astype(int)
    cuts = np.flatnonzero(np.diff(balance * (bins.max() + 1) + bins, prepend=-1))
    count = np.diff(np.append(cuts, len(bins)))
    return np.add.reduceat(columns, cuts, axis=0) / np.sqrt(count)[:, None], bins[cuts], balance[cuts]


def whitened(rows, bins, balance):
    """Each balance less what its residual's last rows foretell (autoregression, Yule-Walker), in units of what is left."""
    out = []
    for one in np.unique(balance):
        part, at = rows[balance == one], bins[balance == one]
        y, run = part[:, 0], np.cumsum(np.diff(at, prepend=at[0] - 1) != 1)  # rows left out part a balance into runs
        together = [run[k:] == run[: len(run) - k] for k in range(LAGS + 1)]
        covariance = np.array([(y[k:] * y[: len(y) - k])[same].sum() / max(1, same.sum()) for k, same in enumerate(together)])
        covariance[0] = covariance[0] * 1.0001 + 1e-9
        foretell = solve_toeplitz(covariance[:LAGS], covariance[1:])
        left, known = part.copy(), np.ones(len(y), bool)
        for k in range(1, LAGS + 1):
            left[k:] -= foretell[k - 1] * part[:-k]
            known[:k] = False
            known[k:] &= together[k]
        variance = max(covariance[0] - foretell @ covariance[1:], 1e-3 * covariance[0])
        out.append(left[known] / np.sqrt(variance))
    return np.vstack(out)


def regression(path):
    """Y and X (columns of unit norm) with the baseline's parameters projected out, and the effect of each column."""
    time, balance, stacked, own, effects = read(path)
    rows = whitened(*thinned(time, balance, stacked))
    rows *= np.sqrt(np.minimum(1, HUBER / np.maximum(1e-9, np.abs(rows[:, 0]))))[:, None]
    held = [k for k, p in enumerate(own) if p["prior"] > 0]  # a data sheet's tolerance is a row too
    priors = np.zeros((len(held), rows.shape[1]))
    for row, k in enumerate(held):
        priors[row, 0], priors[row, 1 + k] = -own[k]["increment"] / own[k]["prior"], 1 / own[k]["prior"]
    rows = np.vstack([rows, priors])
    Y, N, X = rows[:, 0], rows[:, 1 : 1 + len(own)], rows[:, 1 + len(own) :]
    size = np.sqrt((N**2).sum(0))
    q, _ = np.linalg.qr(N[:, size > 0] / size[size > 0])
    before = np.sqrt((X**2).sum(0))
    Y, X = Y - q @ (q.T @ Y), X - q @ (q.T @ X)
    size = np.sqrt((X**2).sum(0))
    keep = size > 1e-4 * before + 1e-12  # the rest is what the baseline's own parameters can do
    return Y, X[:, keep] / size[keep], [e for e, k in zip(effects, keep) if k]
