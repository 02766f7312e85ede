"""Writes network_arrays.mat and network_arrays.json: a network as MATLAB leaves it, and depths of
histograms as MATLAB computes them, normalisation and all. Run here, with numpy and scipy."""

import json

import numpy as np
from scipy.io import savemat

rng = np.random.default_rng(7)
bins, neurons = 256, 8
xmin = rng.integers(0, 5, bins).astype(float)
xmax = xmin + rng.integers(500, 3000, bins)
x = {"xoffset": xmin, "gain": 2 / (xmax - xmin), "ymin": -1.0}
y = {"xoffset": 0.1, "gain": 4.0, "ymin": -1.0}
IW = rng.normal(0, 0.3, (neurons, bins))
LW = rng.uniform(-1, 1, (1, neurons))
b1 = rng.uniform(-1, 1, (neurons, 1))
b1 += (IW * (x["xoffset"] * x["gain"] + 1)).sum(axis=1, keepdims=True) - b1.sum() / 8
b2 = np.array([[-0.4]])

histograms = rng.poisson(60, (5, bins)).astype(float)
for k, histogram in enumerate(histograms):
    histogram[40 * k + 20 : 40 * k + 30] += 900


def depth(counts):
    normalised = (counts - x["xoffset"]) * x["gain"] + x["ymin"]
    hidden = np.tanh(IW @ normalised + b1[:, 0])
    out = LW @ hidden + b2[0]
    return float((out[0] - y["ymin"]) / y["gain"] + y["xoffset"])


names = {f"x_{key}": value for key, value in x.items()} | {f"y_{key}": value for key, value in y.items()}
column = {key: np.reshape(value, (-1, 1)) for key, value in names.items()}
savemat("network_arrays.mat", {"IW": IW, "LW": LW, "b1": b1, "b2": b2} | column, do_compression=True)
with open("network_arrays.json", "w") as file:
    network = {"IW": IW.tolist(), "LW": LW[0].tolist(), "b": [b1[:, 0].tolist(), [float(b2[0, 0])]]}
    network |= {side: {key: np.asarray(value).tolist() for key, value in settings.items()} for side, settings in (("x", x), ("y", y))}
    json.dump(network, file)
    file.write("\n")
with open("network_arrays_depths.json", "w") as file:
    json.dump({"histograms": histograms.astype(int).tolist(), "depths_m": [depth(h) for h in histograms]}, file)
    file.write("\n")
