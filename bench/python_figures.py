# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""What bench/python.sh runs: each figure in a process of its own."""

import resource
import subprocess
import sys
from pathlib import Path

import own_scanner
import pulsecast


def user_seconds():
    return resource.getrusage(resource.RUSAGE_SELF).ru_utime


def memory(field):
    """Of this process, by the system: VmRSS or VmHWM [MB]."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith(field))
    return int(line.split()[1]) * 1024 / 1e6


def survey(out, document=None, *assets):
    """Leaves the survey to be timed: the one given, or one of the tests with more pulses."""
    folder = Path(__file__).parent.parent / "tests" / "examples" / "pulsecast"
    settings = pulsecast.read_survey(document or folder / "long.xml", assets=assets or [folder])
    if not document:
        for leg in settings.legs:
            leg.scanner.pulse_rate = 1_000_000
        for part in settings.scene.parts:
            part.swaps = []
    pulsecast.write_survey(out, settings)


def run(document, threads, pulses, *assets):
    """Runs it, for points alone or with pulses, and says the time in user mode."""
    simulation = pulsecast.Simulation(pulsecast.read_survey(document, assets=assets), assets=assets, seed=1, threads=int(threads))
    start = user_seconds()
    result = simulation.run(threads=int(threads), pulses=pulses == "pulses")
    print(user_seconds() - start, len(result.points), result.slots)


def time(program, rows, document, threads, rounds, folder, *assets):
    """Of the program that writes LAS, of C++ that keeps points in memory, and of the module that makes arrays of them: turn by turn."""

    def taken(*command):
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        said = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, said

    options = [word for folder_of_assets in assets for word in ("--assets", folder_of_assets)]
    names = ("program with LAS", "C++ in memory, all", "run", "module, all", "run", "module with pulses, all", "run")
    rows_of_times = []
    for _ in range(int(rounds)):
        las, _ = taken(program, document, *options, "--output", folder, "--format", "las", "--seed", "1", "--threads", threads, "--quiet")
        cpp, [cpp_run] = taken(rows, document, "1", threads, "", *assets)
        alone, [alone_run, points, slots] = taken(sys.executable, __file__, "run", document, threads, "points", *assets)
        both, [both_run, *_] = taken(sys.executable, __file__, "run", document, threads, "pulses", *assets)
        rows_of_times.append((las, cpp, float(cpp_run), alone, float(alone_run), both, float(both_run)))
        print("time [s]: " + "; ".join(f"{name} {one:.2f}" for name, one in zip(names, rows_of_times[-1])), flush=True)
    # what else the machine does only adds, so the least says most
    las, _, cpp_run, alone, alone_run, both, both_run = (min(column) for column in zip(*rows_of_times))
    more = [f"{100 * (one / other - 1):+.1f} %" for one, other in ((alone_run, cpp_run), (both_run, cpp_run), (alone, las), (both, las))]
    print(f"time: {int(slots):,} pulses, {int(points):,} points, {threads} threads, the least of {rounds}: the module's run {more[0]} of that of C++ in "
          f"memory, {more[1]} with pulses; all of it {more[2]} of the program with LAS, {more[3]} with pulses")


def points(count, kept="rows"):
    """The most memory that so many points take, as rows or by column, against their own bytes; and the time in user mode."""
    scanner = own_scanner.RosetteSurvey(int(count))
    before, start = memory("VmRSS"), user_seconds()
    result = scanner.run(columns=kept == "columns")
    taken, seconds = memory("VmHWM") - before, user_seconds() - start
    of_points = sum(column.nbytes for column in result.columns.values()) if kept == "columns" else result.points.nbytes
    own = (of_points + result.pulses.nbytes) / 1e6
    stream = ""
    if kept == "columns":
        peak = memory("VmHWM")
        capsule = result.__arrow_c_stream__()
        stream = f"; their Arrow stream takes {memory('VmHWM') - peak:.1f} MB more"
        del capsule
    print(f"memory: {len(result.columns['x']):,} points as {kept} take {taken:.0f} MB at most, arrays of {of_points / 1e6:.0f} MB and, of pulses, "
          f"{result.pulses.nbytes / 1e6:.0f} MB: {taken / own:.3f} of their bytes; {seconds:.2f} s{stream}")


def loop(count, folder):
    """Memory after each of many surveys."""
    after = []
    for seed in range(int(count)):
        settings = pulsecast.read_survey(Path(folder) / "survey.xml", assets=[folder])
        pulsecast.Simulation(settings, assets=[folder], seed=seed, waveforms=True).run()
        after.append(memory("VmRSS"))
    print(f"loop: {after[0]:.2f} MB after the first survey, {after[1]:.2f} MB after the second, {after[-1]:.2f} MB after the {len(after)}th, "
          f"at most {max(after[1:]):.2f} MB")


if __name__ == "__main__":
    {"survey": survey, "run": run, "time": time, "memory": points, "loop": loop}[sys.argv[1]](*sys.argv[2:])
