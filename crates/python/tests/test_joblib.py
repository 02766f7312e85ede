"""The lines on joblib in `docs/cluster.md`."""

import numpy as np
import tofsim
from joblib import Parallel, delayed
from numpy.typing import NDArray


def depths(scenario: tofsim.Scenario) -> NDArray[np.float64]:
    return tofsim.simulate(scenario, 20, "shot", threads=1).depth_m


def test_scenarios_go_to_other_processes() -> None:
    scenarios = [tofsim.Scenario("kc705").with_(target={"distance_m": m}) for m in (0.1, 0.2, 0.3)]
    runs = Parallel(n_jobs=2)(delayed(depths)(scenario) for scenario in scenarios)
    for run, scenario in zip(runs, scenarios):
        assert run.tobytes() == depths(scenario).tobytes()
