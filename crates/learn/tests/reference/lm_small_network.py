#!/usr/bin/env python3
"""Ten epochs of Levenberg-Marquardt on a 1-2-1 network, for src/training/lm.rs.

Needs numpy. Written after Hagan and Menhaj (1994) and the description of MATLAB's trainlm, with
derivatives by complex steps and a general solver, so that it shares no method with the Rust.

    python3 lm_small_network.py > lm_small_network.csv
"""
import numpy as np

t = np.arange(11) / 5.0 - 1.0
target = t * t + 0.3 * t


def residuals(x):
    hidden = np.tanh(np.outer(t, x[0:2]) + x[2:4])
    return hidden @ x[4:6] + x[6] - target


def jacobian(x):
    columns = []
    for k in range(len(x)):
        moved = x.astype(complex)
        moved[k] += 1e-30j
        columns.append(residuals(moved).imag / 1e-30)
    return np.stack(columns, axis=1)


x = np.array([0.5, -0.8, 0.1, -0.2, 0.3, 0.4, 0.05])
mu = 1e-3
print(f"# numpy {np.__version__}")
print("epoch,mu,cost,w1_0,w1_1,b1_0,b1_1,w2_0,w2_1,b2")
for epoch in range(1, 11):
    r, j = residuals(x), jacobian(x)
    cost = np.mean(r * r)
    while True:
        step = np.linalg.solve(j.T @ j / len(r) + mu * np.eye(len(x)), j.T @ r / len(r))
        if np.mean(residuals(x - step) ** 2) < cost:
            x, mu = x - step, mu * 0.1
            break
        mu *= 10
    print(",".join(repr(float(v)) for v in [epoch, mu, np.mean(residuals(x) ** 2), *x]))
