"""The runs that are compared with those of a commit: the same set, whatever the commit."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from net.outside import Act
from net.plcs import script
from net.random_programs import random_program

ROOT: Final = Path(__file__).resolve().parents[2]
FACE: Final = {"plant.probe.Z.face_mm": 100.0, "plant.probe.Z.material": "below", "axis.Z.start_mm": 110.0}
STOP: Final = {"plant.stop.Z.at_mm": 105.0, "plant.stop.Z.side": "above", "axis.Z.start_mm": 90.0}
NEXT: Final = "%next\nN900 G90 G01 X5 Z120 F9000\nN910 M30\n"
_WRITE: Final = "#DRIVE WR SYN [AX=Z KEY={} VAL={} WAIT]\n"
LIMITED: Final = _WRITE.format("TORQUE_LIMIT", 10) + _WRITE.format("MON_WINDOW", 4_294_967_295)


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Programs behind one another on a bench. `plcs` None: the machine's own; else texts of scripts by name.

    `acts` go by program; `machine` is a name, or a folder of the commit's own tree.
    """

    name: str
    programs: Sequence[str]
    settings: Mapping[str, Any] = field(default_factory=dict)
    machine: str = "demo"
    plcs: Mapping[str, str] | None = None
    acts: Mapping[int, Sequence[Act]] = field(default_factory=dict)
    processes: bool = False
    limit_s: float = 60.0
    rest_ms: int = 20


def homing(name: str = "X", start_mm: float = 0.0, **more: object) -> dict[str, object]:
    """Return an incremental axis with its cam below -50 and the zero pulse at -55."""
    values: dict[str, object] = {
        f"axis.{name}.start_mm": start_mm,
        f"axis.{name}.kenngr.abs_pos_gueltig": 0,
        f"axis.{name}.getriebe[0].vb_refmax": 80_000,
        f"axis.{name}.getriebe[0].vb_reflow": 20_000,
        f"axis.{name}.getriebe[0].pos_refpkt": -550_000,
        f"plant.cam.{name}.from_mm": -90.0,
        f"plant.cam.{name}.to_mm": -50.0,
    }
    return values | {f"axis.{name}.{key}": value for key, value in more.items()}


def text(*blocks: str) -> str:
    """Return a program of these blocks."""
    numbered = "".join(f"N{number}0 {block}\n" for number, block in enumerate((*blocks, "M30"), 1))
    return f"%run\n{numbered}"


def _supplied() -> Iterator[Run]:
    for name in ("probe", "meas1", "meas2", "meas3", "meas4"):
        program = (ROOT / "programs" / f"{name}.nc").read_text()
        face = {
            "plant.probe.Z.face_mm": 55.5 if name == "meas4" else 100.0,
            "plant.probe.Z.material": "below",
        }
        for source in ("PLC", "PLC_TIMESTAMP", "DRIVE"):
            signals = {f"axis.{axis}.kenngr.measure.signal": source for axis in "XYZ"}
            yield Run(name=f"{name}_{source.lower()}", programs=[program], settings=face | signals)
    program = (ROOT / "programs" / "meas_fixed_stop.nc").read_text()
    yield Run(name="meas_fixed_stop", programs=[program], settings=STOP)


def _golden() -> Iterator[Run]:
    for folder in sorted((ROOT / "tests" / "nc").iterdir()):
        if (folder / "program.nc").is_file():
            program = (folder / "program.nc").read_text()
            yield Run(name=f"nc_{folder.name}", programs=[program], settings=FACE | homing(), limit_s=8.0)


def _probing() -> Iterator[Run]:
    sources = ("PLC", "PLC_TIMESTAMP", "DRIVE", "FIXED_STOP", "PLC_EXT_LATCH_CONTROL", "PLC_FIRST_EVENT")
    for kind in (1, 2, 3, 4, 7):
        for source in sources if kind == 1 else sources[:4]:
            signals = {f"axis.{axis}.kenngr.measure.signal": source for axis in "XYZ"}
            axes = "X1 Y1 Z90" if kind == 4 else "Z90"
            program = text(f"#MEAS MODE[{kind}]", "G90 G01 Z105 F6000", f"G100 {axes} F900", "G01 Z110 F6000")
            yield Run(name=f"type{kind}_{source.lower()}", programs=[program], settings=FACE | signals)
    twice = text(
        "G90 G01 Z105 F6000", "G100 Z90 F600", "G01 Z106 F6000", "G100 Z90 F1200", '#MSG ["%f",V.A.MESS.Z]'
    )
    for name, value in (("pretravel_um", 40.0), ("bounce_us", 2500.0), ("sigma_um", 0.8)):
        yield Run(name=f"probe_{name}", programs=[twice], settings=FACE | {f"plant.probe.{name}": value})
    for name, more in {
        "edge_neg": {"axis.Z.kenngr.measure.edge": "NEG", "axis.Z.start_mm": 95.0},
        "input_2": {"axis.Z.probe_input_2": "probe", "axis.Z.kenngr.measure.input": 2},
        "skew": {"terminal.probe.clock_skew_ns": 40_000},
        "delay": {"terminal.probe.delay_ns": 700_000},
        "in_the_material": {"axis.Z.start_mm": 95.0},
        "no_face": {"plant.probe.Z.face_mm": -500.0},
        "no_signal_is_error": {"channel.meas_error_no_signal": 1, "plant.probe.Z.face_mm": -500.0},
        "stuck": {"fault.0.kind": "probe_stuck", "fault.0.value": 1, "fault.0.at_ms": 40.0},
        "stuck_low": {"fault.0.kind": "probe_stuck", "fault.0.value": 0},
        "stuck_short": {
            "fault.0.kind": "probe_stuck",
            "fault.0.value": 1,
            "fault.0.at_ms": 300,
            "fault.0.for_ms": 30,
        },
        "fault_at_a_condition": {"fault.0.kind": "probe_stuck", "fault.0.when": "probe"},
        "frame_loss": {"fault.0.kind": "frame_loss", "fault.0.value": 0.1},
    }.items():
        yield Run(name=f"probing_{name}", programs=[twice], settings=FACE | more)
    shift = text(
        "G92 Z33",
        "#CS ON[1,2,3,10,0,20]",
        "G90 G01 X1 Z80 F6000",
        "G100 Z20 F900",
        "G101 Z1",
        "G01 Z40",
        "#CS OFF",
    )
    yield Run(name="probing_cs", programs=[shift], settings=FACE)
    yield Run(name="probing_in_processes", programs=[twice], settings=FACE, processes=True)


def _homing() -> Iterator[Run]:
    one = text("G74 X1", "G90 G01 X-20 F9000")
    for name, settings in {
        "plc": homing(),
        "drive_input": homing(**{"antr.reference_cam_signal": "STATUS_DIG_INPUTS", "input.home": "cam.X"}),
        "no_zero_pulse": homing(**{"kenngr.homing_without_zero_pulse": 1}),
        "fast_from_cam": homing(**{"kenngr.fast_from_cam": 1}),
        "positive": homing(start_mm=-140.0, **{"kenngr.ref_richt": 1}),
        "on_cam": homing(start_mm=-70.0),
        "no_cam": homing() | {"plant.cam.X.from_mm": 900.0, "plant.cam.X.to_mm": 950.0},
        "disabled": homing(**{"kenngr.homing.homing_type": "DISABLED"}),
        "stop_before_cam": homing() | {"plant.stop.X.at_mm": -30.0, "plant.stop.X.side": "below"},
    }.items():
        yield Run(name=f"homing_{name}", programs=[one], settings=settings, limit_s=15.0)
    both = homing() | homing("Y", 30.0)
    yield Run(name="homing_together", programs=[text("G74 X1 Y1", "G90 G01 X0 Y0 F9000")], settings=both)
    yield Run(name="homing_ranks", programs=[text("G74 X2 Y1", "G90 G01 X0 Y0 F9000")], settings=both)
    yield Run(name="homing_without_plc", programs=[one], settings=homing(), plcs={}, limit_s=5.0)
    yield Run(
        name="homing_restless",
        programs=[one],
        settings=homing(),
        plcs={"r": script("restless")},
        limit_s=20.0,
    )


def _fixed_stop() -> Iterator[Run]:
    program = text("#MEAS MODE[7]", "G00 Z100", LIMITED + "N35 G100 Z112 F900", "G01 Z95 F6000")
    for name, more in {
        "plain": {},
        "no_stop": {"plant.stop.Z.at_mm": 300.0},
        "no_stop_no_error": {"plant.stop.Z.at_mm": 300.0, "channel.meas_fixed_stop_no_error": 1},
        "min_time": {"axis.Z.kenngr.measure.fixed_stop_detect.min_time": 120_000},
        "soft": {"plant.stop.Z.stiffness_n_per_um": 2.0},
    }.items():
        yield Run(name=f"fixed_stop_{name}", programs=[program], settings=STOP | more)


def _outside() -> Iterator[Run]:
    move = text("G90 G01 X300 Y40 F20000", "X0 Y0", "G04 0.2", "X20")
    probe = text("G90 G01 Z108 F6000", "G100 Z90 F900", "G01 Z110 F6000")
    stop = text("#MEAS MODE[7]", "G00 Z100", LIMITED + "N35 G100 Z112 F900", "G01 Z95 F6000")
    for what in ("interrupt", "reset"):
        for at_ms in (30.0, 400.0, 1500.0):
            acts = {0: [Act(what, at_ms)]}
            yield Run(name=f"{what}_move_{at_ms:g}", programs=[move, NEXT], acts=acts)
        yield Run(name=f"{what}_probe", programs=[probe, NEXT], settings=FACE, acts={0: [Act(what, 500.0)]})
        yield Run(name=f"{what}_stop", programs=[stop, NEXT], settings=STOP, acts={0: [Act(what, 900.0)]})
        home = text("G74 X1", "G90 G01 X-20 F9000")
        yield Run(
            name=f"{what}_homing", programs=[home, home], settings=homing(), acts={0: [Act(what, 400.0)]}
        )
    unit = "ch/1/bahn_mc_control"
    held = [
        Act("put", 1.0, "ch/1/head/plc_present_w", 1),
        Act("put", 2.0, f"{unit}/feedhold/enable_w", 1),
        Act("put", 200.0, f"{unit}/feedhold/command_w", 1),
        Act("put", 600.0, f"{unit}/feedhold/command_w", 0),
        Act("put", 700.0, f"{unit}/delete_distance_to_go/enable_w", 1),
        Act("put", 701.0, f"{unit}/delete_distance_to_go/command_w", 1),
        Act("put", 800.0, "ax/1/ipo_mc_control/feedhold/enable_w", 1),
        Act("put", 801.0, "ax/1/ipo_mc_control/feedhold/command_w", 1),
        Act("put", 999.0, "ax/1/ipo_mc_control/feedhold/command_w", 0),
    ]
    yield Run(name="held_by_a_client", programs=[move], acts={0: held}, plcs={})
    slow = [
        Act("put", 1.0, "ch/1/head/plc_present_w", 1),
        Act("put", 500.0, f"{unit}/override/command_w", 250),
    ]
    slow += [Act("put", 2.0, f"{unit}/override/enable_w", 1)]
    yield Run(name="slowed_by_a_client", programs=[move], acts={0: slow}, plcs={})
    yield Run(name="held_for_ever", programs=[move, NEXT], acts={0: held[:3]}, plcs={}, limit_s=3.0)


def _errors() -> Iterator[Run]:
    for name, block in {
        "limit": "G90 G01 X9999 F9000",
        "limit_negative": "G90 G01 X-9999 F9000",
        "type": "#MEAS MODE[9]",
        "no_axis": "G100 F500",
        "twice": "G101 X1",
        "not_built": "G02 X1 Y1 I1 J1",
        "broken": "G01 X$ F",
        "drive": "#DRIVE WR SYN [AX=X KEY=NOTHING VAL=1 WAIT]",
        "homing_rank": "G74 X0",
        "spindle": "S1000",
    }.items():
        yield Run(name=f"error_{name}", programs=[text("G90 G01 X1 F9000", block, "X2"), NEXT], settings=FACE)
    stop = {"plant.stop.X.at_mm": 100.0, "plant.stop.X.side": "above"}
    yield Run(name="error_lag", programs=[text("G90 G01 X300 F20000"), NEXT, NEXT], settings=stop)


def _plcs() -> Iterator[Run]:
    program = text("G90 G01 Z105 F6000", "G100 Z90 F600", "G01 Z106 X20 F6000", "G74 X1", "X3")
    for kind in ("good", "restless", "flicker", "silent", "fails"):
        for period_us in (1000, 4000):
            plcs = {kind: script(kind, period_us=period_us, seed=period_us)}
            name = f"plc_{kind}_{period_us}"
            yield Run(name=name, programs=[program, NEXT], settings=FACE | homing(), plcs=plcs, limit_s=20.0)
    two = {"slow": script("silent", period_us=8000), "good": script("good", period_us=2000)}
    yield Run(name="plc_two", programs=[program], settings=FACE | homing(), plcs=two)
    apart = {"plc.0.process": True}
    yield Run(name="plc_process", programs=[program], settings=FACE | homing() | apart)


def _machines() -> Iterator[Run]:
    program = text(
        "G90 G01 Z105 X3 F6000", "G100 Z90 F600", "G01 Z106 X20 F6000", "G04 0.1", "X30 Y10", "X31", "X32 Y11"
    )
    for cycle_us in (250, 500, 2000, 4000, 10_000):
        settings = FACE | {
            "cycle_us": cycle_us,
            "plc.0.period_us": cycle_us,
            "terminal.probe.period_us": cycle_us,
        }
        settings |= {"terminal.cams.period_us": cycle_us}
        yield Run(name=f"cycle_{cycle_us}", programs=[program], settings=settings)
    good = {"good": script("good")}
    yield Run(name="three_axes", programs=[program], machine="benchmarks/machines/three_axes", plcs=good)
    eight = text("G90 G01 X50 Y40 Z280 F9000", "G01 X0 A30 F9000", "G00 X0 Y0", "X1 Y1")
    yield Run(name="eight_axes", programs=[eight], machine="benchmarks/machines/eight_axes")
    yield Run(name="demo_rotary", programs=[text("G90 G01 A30 B-20 F4000", "X10 A0", "G00 B0")])
    yield Run(name="one_after_another", programs=[program] * 4, settings=FACE)


def _random() -> Iterator[Run]:
    settings = (
        FACE
        | homing()
        | {"axis.Z.start_mm": 60.0, "plant.probe.Z.face_mm": 40.0, "plant.probe.sigma_um": 0.7}
    )
    for seed in range(1, 13):
        kind = ("good", "restless", "good")[seed % 3]
        plcs = {kind: script(kind, period_us=(1000, 2000, 7000, 20_000)[seed % 4], seed=seed)}
        programs = [random_program(seed)]
        yield Run(name=f"random_{seed}", programs=programs, settings=settings, plcs=plcs, limit_s=30.0)


def all_runs() -> list[Run]:
    """Return the whole set."""
    groups = (
        _supplied,
        _golden,
        _probing,
        _homing,
        _fixed_stop,
        _outside,
        _errors,
        _plcs,
        _machines,
        _random,
    )
    return [run for group in groups for run in group()]
