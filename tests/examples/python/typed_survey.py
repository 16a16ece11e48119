# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""A program whose types are checked, and which is run: a tripod over a floor of arrays. Lines marked `wrong` must be refused by mypy."""

import sys
from typing import TYPE_CHECKING

import numpy as np

import pulsecast

channel = pulsecast.ChannelSettings(optic=pulsecast.RotatingOptic(), scan_angle_max=1.0, head_rate_max=3.0)
channel.waveform.rings = 1
survey = pulsecast.SurveySettings(
    name="floor",
    scanner=pulsecast.ScannerSettings(id="scanner", pulse_rates=[10_000], channels=[channel]),
    legs=[pulsecast.LegSettings(scanner=pulsecast.LegScannerSettings(scan_rate=50, head_rate=3, head_stop=3))],
)
survey.legs[0].platform.position = (0, 0, 2)
for leg in survey.legs:
    leg.platform.position = (*leg.platform.position[:2], 3)
survey.platform.kind = "stationary"

floor = pulsecast.Mesh([[-50, -50, 0], [50, -50, 0], [50, 50, 0], [-50, 50, 0]], np.array([[0, 1, 2], [0, 2, 3]]), ground=True)
batches: list[pulsecast.Batch] = []
simulation = pulsecast.Simulation(survey, assets=pulsecast.asset_folders(), meshes=[floor])
try:
    simulation.run(callback=batches.append, every_pulses=1000, progress=lambda done, total, echoes, seconds: None)
except pulsecast.SettingError as error:
    sys.exit(f"{error.field} = {error.value} {error.unit}")
except pulsecast.Interrupted as stopped:
    batches = [stopped.result]
heights = np.concatenate([batch.points["z"] for batch in batches])
print(len(heights), "points", float(np.abs(heights).max()), sum(batch.fates["returned"] for batch in batches))

if TYPE_CHECKING:
    survey.legs[0].platform.sped = 3  # wrong
    survey.platform.kind = "plane"  # wrong
    survey.seed = "1"  # wrong
    survey.legs.append(None)  # wrong
    survey.legs[0].scanner.scan_angle + 1  # wrong: may be None
    pulsecast.LegSettings(speed=3)  # wrong
    pulsecast.Simulation(survey, [])  # wrong: by name only
    simulation.run(callback=lambda: None)  # wrong
    simulation.run(output=3)  # wrong
    simulation.run(output=["floor.laz", "floor.html"], las_scale=1e-3, format="laz", colours=True)
    batches[0].write("floor.ply", ["age"])  # wrong: by name only
    simulation.memory = 0  # wrong
    simulation.bounds[0]  # wrong: may be None
    channel.optic = 3  # wrong
