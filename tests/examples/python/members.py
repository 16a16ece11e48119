# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""All members of the Python module, and how it reaches each setting of a survey in C++: `python3 members.py > docs/tables/python.md`."""

import dataclasses
import inspect
import re
from pathlib import Path

import pulsecast

INCLUDE = Path(__file__).parents[3] / "include" / "pulsecast"
ROOMS = ("sensor", "platform", "deflector", "detector", "scanner", "material", "scene", "shape", "transport")

# Settings of C++ whose names are others in Python: members of classes, or arguments of their constructors.
REACHED = {
    "GroundVehicleSettings": ("PlatformSettings.kind", "LegPlatformSettings.speed"), "plan_ground_vehicle": ("PlatformSettings.kind",),
    "MulticopterSettings": ("MulticopterDynamics", "LegPlatformSettings.smooth_turn"), "plan_multicopter": ("PlatformSettings.kind",),
    "Mount": ("PlatformSettings.mount",), "PoseErrors": ("PoseErrorSettings", "NoiseSettings", "MountErrorSettings"),
    "StraightLine": ("LegPlatformSettings.position", "LegPlatformSettings.speed"), "Tripod": ("LegPlatformSettings.position",),
    "Waypoints": ("Simulation(trajectories)", "TrajectorySettings"),
    "FiberArray": ("LineOptic",), "FixedBeam": ("LegScannerSettings.scan_rate",), "OscillatingMirror": ("OscillatingOptic",),
    "PalmerMirror": ("ConicOptic",), "PolygonMirror": ("RotatingOptic",), "RisleyPrisms": ("RisleyOptic",),
    "RotatingHead": ("ChannelSettings.head_axis", "LegScannerSettings.head_rate"),
    "GaussianFit": ("Simulation(echo_width)",), "RangeErrors": ("ChannelSettings.accuracy", "ErrorFormulas.range_noise"),
    "Receiver": ("ChannelSettings",), "ReceiverNoise": ("Simulation(waveform_noise)",), "WaveformSettings": ("FullWaveformSettings",),
    "Scanner": ("ScannerSettings", "ChannelSettings"),
    "Image": ("Mesh(picture)",), "Material": ("Mesh(reflectance)", "Mesh(classification)", "Mesh(law)"), "SurfaceLaw": ("Mesh(law)",),
    "MediumRegion": ("MediumSettings",), "Precipitation": ("MediumSettings.rate",), "WaterState": ("Medium(absorption)", "Medium(index)"),
    "ReflectanceMap": ("MeshSource.materials", "ObjSource.files"), "Beads": ("MeshSource.materials", "ObjSource.files"),
    "CubeCorners": ("MeshSource.materials", "ObjSource.files"), "Retroreflector": ("MeshSource.materials", "ObjSource.files"),
    "SteadyMotion": ("MotionSequenceSettings", "Mesh(motion)"), "PartMotion": ("MotionSequenceSettings", "Mesh(motion)"),
    "Placement": ("Mesh(placements)", "TransformSettings"),
    "ClassMaterials": ("GeoTiffSource.classes",), "Mask": ("Mesh(cutoff)",), "MeshData": ("Mesh",), "Raster": ("GeoTiffSource",),
    "TransmissiveVoxels": ("VoxelSource.mode",), "VoxelData": ("VoxelSource", "XyzSource"),
    "LightPaths": ("LightSettings",), "MultipleScattering": ("LightSettings.orders",),
}

SENSORS = "a sensor with times of firing, for a `SensorKit` in C++; `catalogue` has the same instruments as `ScannerSettings`"
DETECTORS = "a detector of user-defined pipelines (`bind_survey`): documents have full waveforms"
WAVES = "a water surface with waves, in C++; Python has calm ones, `SmoothInterface.water` of a `Mesh`"
LOW_LEVEL = "a part of others, which set it"
WITHOUT = {
    "Earth": "of an `ImuSettings`", "InertialErrors": "of an `ImuSettings`", "ImuSettings": "an inertial sensor, which sends no pulses",
    "PixelArray": SENSORS, "SensorSheet": SENSORS, "SpinningSensor": SENSORS,
    "PatternTable": "a measured pattern of beams: documents have the optics by their laws",
    "FirstHit": DETECTORS, "FmcwSettings": DETECTORS, "PhaseShiftSettings": DETECTORS, "PhotonCountingSettings": DETECTORS,
    "ReceiverChain": DETECTORS,
    "WaterArea": WAVES, "SineWave": WAVES, "WindWaves": WAVES,
    "DetectorAdaptor": LOW_LEVEL, "BeamExit": LOW_LEVEL, "ReflectanceByTexture": LOW_LEVEL, "PackedHeights": LOW_LEVEL, "ApertureGeometry": LOW_LEVEL,
    "HillshadeSettings": "a picture of heights, no survey",
}


def settings_of_cpp():
    """Yields (name, header) of the public settings by which a survey is made: what validates itself, motions, and planners."""
    for room in ROOMS:
        for header in sorted((INCLUDE / room).glob("*.hpp")):
            text = header.read_text(encoding="utf-8")
            text = re.sub(r"^namespace detail \{$.*?^\}  // namespace detail$", "", text, flags=re.MULTILINE | re.DOTALL)
            for name, body in re.findall(r"^(?:struct|class) (\w+)[^;{]*\{\n(.*?)^\};", text, re.MULTILINE | re.DOTALL):
                is_motion = re.search(rf"  explicit {name}\((?:const )?std::vector<\w*(?:Pose|Motion)", body)
                if "void validate() const" in body or is_motion:
                    yield name, f"{room}/{header.name}"
            for name in re.findall(r"^\[\[nodiscard\]\] .*?\b(plan_\w+)\(", text, re.MULTILINE):
                yield name, f"{room}/{header.name}"


def has(place):
    """Whether the module has a name, a member `Class.member`, or an argument `Class(argument)`."""
    match = re.fullmatch(r"(\w+)(?:\.(\w+)|\((\w+)\))?", place)
    found = getattr(pulsecast, match[1], None)
    if found is None:
        return False
    if match[3]:
        return re.search(rf"\b{match[3]}: ", found.__init__.__doc__) is not None
    return match[2] is None or hasattr(found, match[2])


def ways():
    """Yields (name, header, how Python reaches it or None, the reason if it does not or None)."""
    for name, header in dict(settings_of_cpp()).items():
        places = (name,) if hasattr(pulsecast, name) else REACHED.get(name, ())
        yield name, header, ", ".join(f"`{place}`" for place in places) if places and all(map(has, places)) else None, WITHOUT.get(name)


def text_of(bound):
    """Docstring on one line, without the signature that pybind11 writes above it."""
    doc = (bound.__doc__ or "").strip()
    if re.match(r"\w*\(.*\) -> ", doc):
        doc = doc.partition("\n")[2]
    return re.sub(r"\s+", " ", doc).strip().replace("|", "\\|")


def arguments_of(bound):
    """Names of arguments; of a function of C++ by the signature in its docstring."""
    if inspect.isfunction(bound):
        return ", ".join(inspect.signature(bound).parameters)
    signature = re.match(r"\w+\((.*)\) -> ", bound.__doc__ or "")
    names = re.findall(r"(?:^|, )(\*|\w+)(?=[:,]|$)", signature[1]) if signature else []
    return ", ".join(name for name in names if name not in ("self", "*"))


def names():
    return [name for name in pulsecast.__all__ if not name.startswith("_")]


def members_of(kind):
    """(member, docstring) of a class of C++."""
    for name, member in vars(kind).items():
        if name == "__init__" and arguments_of(member):
            yield f"({arguments_of(member)})", text_of(member)
        elif not name.startswith("_"):
            member = getattr(kind, name)
            call = "" if isinstance(member, property) else f"({arguments_of(member)})"
            yield name + call, text_of(member)


def page():
    yield "# Python: all members"
    yield "\nThis page is what `python3 tests/examples/python/members.py` prints; [docs/python.md](../python.md) explains it."
    yield "\n## Functions\n\n| function | meaning |\n|---|---|"
    classes, settings = [], []
    for name in sorted(names()):
        found = getattr(pulsecast, name)
        if dataclasses.is_dataclass(found):
            settings.append(found)
        elif isinstance(found, type):
            classes.append(found)
        elif callable(found):
            yield f"| `{name}({arguments_of(found)})` | {text_of(found)} |"
    for kind in classes:
        yield f"\n## {kind.__name__}\n\n{text_of(kind)}"
        members = [f"| `{name}` | {text} |" for name, text in members_of(kind)]
        if members:
            yield "\n| member | meaning |\n|---|---|"
            yield from members
    yield "\n## Settings\n\nAngles, in radians, are there in degrees, too, as `NAME_deg`."
    for kind in settings:
        fields = dataclasses.fields(kind)
        yield f"\n### {kind.__name__}\n\n{text_of(kind).partition(fields[0].name + ': ')[0].strip() if fields else text_of(kind)}"
        if fields:
            yield "\n| member | type | meaning |\n|---|---|---|"
        documented = dict(re.findall(r"^(\w+): .*\n    (.*)$", kind.__doc__, re.MULTILINE))
        for field in fields:
            degrees = f", `{field.name}_deg`" if hasattr(kind, field.name + "_deg") else ""
            kind_of = field.type.replace("|", "\\|")
            yield f"| `{field.name}`{degrees} | `{kind_of}` | {documented[field.name].replace('|', chr(92) + '|')} |"
    yield "\n## Settings in C++ and in Python\n\n| C++ | header | Python |\n|---|---|---|"
    for name, header, way, reason in ways():
        yield f"| `{name}` | `{header}` | {way or 'none: ' + str(reason)} |"


if __name__ == "__main__":
    print("\n".join(page()))
