"""The machine folder: the demo, overrides, and every wrong key by file, line, key, value, what is permitted."""

import re
import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from hli_bench.base.errors import BenchError, InputError, NotEmulated
from hli_bench.base.loading import data_file
from hli_bench.bench import folder, schema
from hli_bench.bench.config import MachineConfig
from hli_bench.bench.folder import load
from hli_bench.bench.sources import line_numbers, parse_set
from hli_bench.manual.drive_types import DriveType
from hli_bench.plant.settings import Face
from hli_bench.shells import texts

FACE = {"plant.probe.Z.face_mm": 100, "plant.probe.Z.material": "below"}


def _machine(folder: Path, toml: str, **lists: str) -> Path:
    (folder / "machine.toml").write_text(toml)
    for name, text in lists.items():
        (folder / f"{name}.lis").write_text(text)
    return folder


def test_the_demo_is_what_the_interface_says() -> None:
    demo = load("demo")
    assert [axis.name for axis in demo.axes] == ["X", "Y", "Z", "X2", "A", "B", "S"]
    assert [axis.number for axis in demo.axes] == [axis.node_id for axis in demo.axes] == list(range(1, 8))
    assert "".join(axis.kind for axis in demo.axes) == "TTTTRRS"
    assert demo.axis("Z").start_mm == 300.0
    assert {axis.drive for axis in demo.axes} == {"drives.models.servo402"}
    assert all(axis.params.kenngr.abs_pos_gueltig for axis in demo.axes)
    assert all(axis.face is None and axis.stop is None for axis in demo.plant.axes)
    probe = next(terminal for terminal in demo.terminals if terminal.name == "probe")
    assert (probe.model, probe.wiring) == ("EL1252", {"ch2": "probe"})
    assert [(plc.name, plc.period_us, plc.process) for plc in demo.plcs] == [("demo", 1000, False)]
    assert (demo.name, demo.cycle_ns, demo.sub_steps) == ("demo", 1_000_000, 8)
    assert demo.dc_epoch_ns == 820_540_800_000_000_000
    assert demo.notes == ()


def test_the_demo_homes_onto_its_zero_pulse() -> None:
    demo = load("demo")
    for axis, plant in list(zip(demo.axes, demo.plant.axes, strict=True))[:6]:
        assert plant.cam is not None
        assert not plant.cam.from_mm <= axis.start_mm <= plant.cam.to_mm
        drive = plant.plant
        reference = axis.params.getriebe[0].pos_refpkt / 10_000
        turns = reference / drive.pitch_mm - drive.zero_pulse_increments / drive.increments_per_turn
        assert turns == round(turns)
        assert 0.0 < plant.cam.to_mm - reference < drive.pitch_mm
        assert axis.params.getriebe[0].wegaufz == drive.increments_per_turn
        assert axis.params.getriebe[0].wegaufn == drive.pitch_mm * 10_000


@pytest.mark.req("M-165", "M-166")
def test_the_drive_functions_of_the_demo() -> None:
    window, torque = load("demo").axis("Z").params.antr.function
    assert (window.id, window.wr_ident[0], window.data_type) == ("MON_WINDOW", "6065_00", "UNS32")
    assert (window.scaling_type, window.scaling_factor) == ("UNSCALED", 1.0)
    assert (window.min_limit, window.max_limit) == (0.0, 4294967295.0)
    assert (torque.id, torque.wr_ident[0], torque.data_type) == ("TORQUE_LIMIT", "6072_00", "UNS16")
    assert (torque.scaling_type, torque.scaling_factor) == ("LINEAR", 10.0)
    assert {window.commu, torque.commu} == {"ACYCLIC"}


def test_overrides_of_every_kind() -> None:
    config = load(
        "demo",
        {
            **FACE,
            "channel.messtyp": 7,
            "axis.Z.kenngr.measure.signal": "PLC",
            "axis.Z.getriebe[0].pos_refpkt": "-1000",
            "plc.0.process": True,
            "plant": {"stop": {"X": {"at_mm": 50, "side": "above"}}},
            "dc_epoch": "2026-01-01T00:00:01Z",
            "terminal.probe.wiring.ch1": "cam.Z",
        },
    )
    assert config.channel.messtyp == 7
    assert config.axis("Z").params.kenngr.measure.signal == "PLC"
    assert config.axis("Z").params.getriebe[0].pos_refpkt == -1000
    assert config.plcs[0].process
    assert config.plant.axes[2].face == Face(mm=100.0, material="below")
    assert config.plant.axes[0].stop is not None
    assert config.dc_epoch_ns == 820_540_801_000_000_000
    assert config.terminals[0].wiring == {"ch2": "probe", "ch1": "cam.Z"}
    assert load("demo", {"plc": []}).plcs == ()
    assert [plc.name for plc in load("demo", {"plc": [{"script": "demo.py", "name": "one"}]}).plcs] == ["one"]


def test_set_texts_are_toml_or_text() -> None:
    assert parse_set(["plc.0.process=true", "a.b=PLC_TIMESTAMP", "c = 1.5", 'd="x=y"', "e=x=y"]) == {
        "plc.0.process": True,
        "a.b": "PLC_TIMESTAMP",
        "c": 1.5,
        "d": "x=y",
        "e": "x=y",
    }
    with pytest.raises(InputError, match="--set: 'nothing': expected KEY=VALUE"):
        parse_set(["nothing"])


WRONG = [
    ({"cycle_us": 1001}, "cycle_us: 1001 is not valid, expected integer 125..20000, a multiple of 125"),
    ({"cycle_ms": 1}, r"cycle_ms: unknown key \(did you mean cycle_us\?\)"),
    ({"axis.Q.start_mm": 1}, r"axis.Q.start_mm: 'Q' is not an axis of this machine \(X, Y, Z, X2, A, B, S\)"),
    ({"axis.Q.kenngr.messachse": 1}, "axis.Q.kenngr.messachse: 'Q' is not an axis"),
    (
        {"axis.Z.kenngr.mesachse": 1},
        r"axis.Z.kenngr.mesachse: unknown parameter \(did you mean kenngr.messachse",
    ),
    (
        {"axis.Z.kenngr.measure.signal": "PCL"},
        "axis.Z.kenngr.measure.signal: 'PCL' is out of range|not valid",
    ),
    ({"channel.messtyp": 9}, r"channel.messtyp: 9 is out of range 1\.\.7"),
    ({"plant.probe.Z.face_mm": 1}, "plant.probe.Z.face_mm: needs plant.probe.Z.material"),
    ({**FACE, "plant.probe.Z.material": "left"}, "'left' is not valid, expected one of above, below"),
    ({"plant.probe.Z.fase_mm": 1}, "did you mean plant.probe.Z.face_mm"),
    ({"plant.cam.Z.to_mm": -800.0}, r"plant.cam.Z.to_mm: -800.0 is not above from_mm = -700.0"),
    ({"plant.axis.Z.pitch_mm": 0}, "plant.axis.Z.pitch_mm: 0 is not valid, expected number above 0"),
    ({"plant.axis.Z.inertia_kg_m2": float("nan")}, "is not valid, expected number"),
    ({"axis.Z.node_id": 1}, "axis.Z.node_id: 1 is already that of axis X"),
    ({"axis.Z.kopf.achs_nr": 1}, "axis.Z.kopf.achs_nr: 1 is already that of axis X"),
    ({"axis.Z.start_mm": 30000}, "axis.Z.start_mm: 30000.0 is beyond the encoder"),
    ({"axis.Z.probe_input_2": "porbe"}, r"axis.Z.probe_input_2: 'porbe' is not a signal \(probe, cam.X"),
    ({"axis.Z.input.hom": "cam.Z"}, "'hom' is not one of negative_limit, positive_limit, home"),
    (
        {"terminal.probe.model": "EL1253"},
        "terminal.probe.model: 'EL1253' is not one of EL1008, EL1018, EL1252",
    ),
    ({"terminal.probe.wiring.ch3": "probe"}, r"terminal.probe.wiring.ch3: EL1252 has ch1\.\.ch2 only"),
    ({"terminal.probe.wiring.ch1": "cam.Q"}, "'cam.Q' is not a signal"),
    (
        {"terminal.probe.period_us": 1500},
        "terminal.probe.period_us: 1500 is not a multiple of cycle_us = 1000",
    ),
    ({"terminal.probe.mode": "once"}, "expected one of continuous, single_event"),
    ({"plc.0.script": "none.py"}, "'none.py' is neither in"),
    ({"plc.0.process": 1}, r"plc\[0\].process: 1 is not valid, expected true or false"),
    (
        {"plc.7.script": "x"},
        r"--set: plc\[7\].script = 'x': there is no plc\[7\]; the machine has 1 plc entry, so plc\[1\] is the highest",
    ),
    ({"plc.7.script": "x", "plc.3.name": "y"}, r"--set: plc\[3\].name = 'y': there is no plc\[3\]; "),
    (
        {"fault.1.kind": "probe_stuck"},
        r"the machine has 0 fault entries, so fault\[0\] is the highest, a new one",
    ),
    ({"plc.1.period_us": 1000}, r"--set: plc\[1\].script: is missing"),
    ({"plc.1.script": "demo.py"}, r"--set: plc\[1\].name: 'demo' is already that of another task"),
    ({"fault.0.at_ms": 3}, r"--set: fault\[0\].kind: is missing"),
    ({"fault": [{"kind": "fire"}]}, "'fire' is not valid, expected one of frame_loss, node_off"),
    ({"fault": [{"kind": "probe_stuck", "target": "cam.Q"}]}, r"fault\[0\].target: 'cam.Q' is not a signal"),
    ({"dc_epoch": "1999-12-31"}, "dc_epoch: '1999-12-31' is not valid, expected instant"),
    ({"dc_epoch": "soon"}, "dc_epoch: 'soon' is not valid"),
]


@pytest.mark.parametrize(("overrides", "message"), WRONG)
def test_wrong_overrides(overrides: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        load("demo", overrides)
    assert "--set: " in str(caught.value)


def test_everything_wrong_is_named_with_file_and_line(tmp_path: Path) -> None:
    folder = _machine(
        tmp_path,
        '# a machine\ncycle_us = "fast"\nchannel.list = "c.lis"\n\n[axis.X]\nlist = "x.lis"\nbegin = 3\n'
        "\n[[plc]]\n\n[[plc]]\nperiod_us = 0\n",
        c="messtyp 8\n",
        x="kopf.achs_nr 1\nkenngr.messachs 1\ngetriebe[0].vb_reflow 5000\ngetriebe[0].vb_refmax 4000\n",
    )
    with pytest.raises(InputError) as caught:
        load(folder)
    lines = str(caught.value).splitlines()
    places = [line.split(": ")[0] for line in lines]
    toml, x, c = f"{folder}/machine.toml", f"{folder}/x.lis", f"{folder}/c.lis"
    assert f"{toml}:2" in places
    assert f"{toml}:7" in places
    assert f"{toml}:12" in places
    assert f"{c}:1:1" in places
    assert f"{x}:2:1" in places
    assert f"{x}:3" in places or f"{x}:4" in places
    assert len(lines) == len(set(lines))


def test_a_number_that_two_axes_have_is_named_where_the_list_gives_it(tmp_path: Path) -> None:
    text = '[axis.X]\nlist = "x.lis"\n[axis.Z]\nlist = "z.lis"\n'
    folder = _machine(tmp_path, text, x="kopf.achs_nr 1\n", z="# Z\nkopf.achs_nr 1\n")
    for overrides in ({}, {"axis.X.start_mm": 1.0}):
        with pytest.raises(
            InputError, match=r"axis\.Z\.kopf\.achs_nr: 1 is already that of axis X"
        ) as caught:
            load(folder, overrides)
        assert f"{folder}/z.lis:2: axis.Z.kopf.achs_nr: " in str(caught.value)


def test_a_date_that_no_bench_has_is_shown_as_it_was_written(tmp_path: Path) -> None:
    folder = _machine(tmp_path, "dc_epoch = 1990-01-01\n[axis.X]\nstart_mm = 1\n")
    with pytest.raises(
        InputError, match=r"dc_epoch: 1990-01-01 is not valid, expected instant .* 2000-01-01 to"
    ):
        load(folder)


def test_a_missing_list_names_the_line_that_asks_for_it(tmp_path: Path) -> None:
    folder = _machine(tmp_path, '[axis.X]\nlist = "nowhere.lis"\n')
    with pytest.raises(InputError, match=r"axis\.X\.list: 'nowhere\.lis' is not a readable file") as caught:
        load(folder)
    assert (caught.value.file, caught.value.line) == (str(folder / "machine.toml"), 2)


def test_broken_toml_names_line_and_column(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not valid TOML") as caught:
        load(_machine(tmp_path, "cycle_us = 1000\nseed = = 1\n"))
    assert (caught.value.line, caught.value.column) == (2, 8)


def test_a_machine_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no machine\.toml there"):
        load(tmp_path)
    with pytest.raises(InputError, match="no 'nowhere' in machines/"):
        load("nowhere")
    with pytest.raises(InputError, match="no axis"):
        load(_machine(tmp_path, "seed = 1\n"))


def test_a_small_folder_needs_no_list(tmp_path: Path) -> None:
    config = load(_machine(tmp_path, "[axis.W]\nstart_mm = 1\nkenngr.messachse = 1\n"))
    axis = config.axis("W")
    assert (axis.number, axis.node_id, axis.start_mm, axis.params.kenngr.messachse) == (1, 1, 1.0, True)
    assert (config.terminals, config.plcs, config.faults) == ((), (), ())


def test_what_is_not_built_says_so() -> None:
    with pytest.raises(NotEmulated, match=r"channel: P-CHAN-00071: prog_start\.slope\.profile = 3"):
        load("demo", {"channel.prog_start.slope.profile": 3})
    with pytest.raises(NotEmulated, match="fault frame_loss"):
        load("demo", {"fault": [{"kind": "frame_loss"}]})
    with pytest.raises(NotEmulated, match="at a condition"):
        load("demo", {"fault": [{"kind": "probe_stuck", "when": "moving"}]})


@pytest.mark.parametrize(
    ("parameter", "named"),
    [
        *(
            (f"kenngr.antr_typ = {number}", f"P-AXIS-00020: kenngr.antr_typ = {number} ({name})")
            for number, name in (
                (1, "CONVENTIONAL"),
                (2, "SERCOS"),
                (4, "SIMULATION"),
                (5, "LIGHTBUS"),
                (6, "TERMINAL"),
                (7, "RT_ETHERNET"),
                (16, "VIRTUAL"),
                (32, "CAN"),
            )
        ),
        ("kenngr.achs_mode = 0x4", "P-AXIS-00015: kenngr.achs_mode = 0x4: MODULO (0x4)"),
        ("kenngr.achs_mode = 0x10001", "P-AXIS-00015: kenngr.achs_mode = 0x10001: GANTRY_MASTER"),
        ("kenngr.achs_mode = 0x20001", "P-AXIS-00015: kenngr.achs_mode = 0x20001: GANTRY_SLAVE"),
        ("kenngr.gantry_slave_no_homing = 1", "P-AXIS-00074: kenngr.gantry_slave_no_homing = 1"),
        ("kenngr.gantry_ax_nr = 1", "P-AXIS-00070: kenngr.gantry_ax_nr = 1"),
        ("antr.canopen.cyclic_position_op_mode = 1", "P-AXIS-00463"),
        ('antr.function[3].id = "X"', "P-AXIS-00397: antr.function[3].commu = CYCLIC"),
    ],
)
def test_what_an_axis_asks_for_and_is_not_built_is_named_with_its_place(
    tmp_path: Path, parameter: str, named: str
) -> None:
    path, value = parameter.replace('"', "").split(" = ")
    place = re.escape(f"NotEmulated: --set: axis.W: {named}")
    with pytest.raises(NotEmulated, match=place):
        load(_machine(tmp_path, "[axis.W]\nstart_mm = 1\n"), {f"axis.W.{path}": value})
    (tmp_path / "w.lis").write_text(f"kopf.achs_nr 1\n{path} {value}\n", encoding="utf-8")
    folder = _machine(tmp_path, '[axis.W]\nlist = "w.lis"\n')
    with pytest.raises(NotEmulated, match=re.escape(f"NotEmulated: {folder}/w.lis:2: axis.W: {named}")):
        load(folder)


def test_everything_that_is_not_built_is_named_at_once(tmp_path: Path) -> None:
    text = "[axis.W]\nkenngr.antr_typ = 2\nkenngr.gantry_offset = 5\n"
    with pytest.raises(NotEmulated) as caught:
        load(_machine(tmp_path, text), {"channel.kasto_multi_block": 1})
    lines = [line.split(": ") for line in str(caught.value).splitlines()]
    assert [(line[0], line[2], line[3]) for line in lines] == [
        ("NotEmulated", "channel", "P-CHAN-00029"),
        ("NotEmulated", "axis.W", "P-AXIS-00020"),
        ("NotEmulated", "axis.W", "P-AXIS-00073"),
    ]


def test_an_axis_that_names_no_drive_type_has_that_of_its_drive(tmp_path: Path) -> None:
    config = load(_machine(tmp_path, "[axis.W]\nstart_mm = 1\n"))
    assert config.axis("W").params.kenngr.antr_typ is DriveType.CANOPEN


def test_what_is_given_and_not_used_is_one_remark(tmp_path: Path) -> None:
    text = "[axis.W]\nkenngr.max_vb_override = 7\nkenngr.messachse = 1\n"
    settings = {
        "channel.meas_pcs_value_no_probe_radius": 1,
        "axis.W.getriebe[0].slope_profil.a_grenz": 900,
    }
    config = load(_machine(tmp_path, text), settings)
    [remark] = config.remarks()
    assert remark.startswith("note: given, and nothing in this bench uses it: ")
    for path in (
        "channel.meas_pcs_value_no_probe_radius (--set)",
        "axis.W.kenngr.max_vb_override (",
        "axis.W.getriebe[0].slope_profil.a_grenz (",
    ):
        assert path in remark
    assert "messachse" not in remark


def test_a_stuck_probe_is_a_record() -> None:
    [fault] = load("demo", {"fault": [{"kind": "probe_stuck", "at_ms": 5, "for_ms": 2.5, "value": 1}]}).faults
    assert (fault.kind, fault.target, fault.at_ns, fault.until_ns) == (
        "probe_stuck",
        "probe",
        5_000_000,
        7_500_000,
    )


def test_line_numbers_of_tables_arrays_and_dotted_keys() -> None:
    text = 'a.b = 1\n[t."x y"]\nk = { m = 1 }\n[[p]]\nq = 1\n[[p]]\nq = 2\n'
    found = line_numbers(text)
    assert (found["a.b"], found["t.x y.k"], found["p[0].q"], found["p[1].q"]) == (
        1,
        3,
        5,
        7,
    )


def test_the_schema_names_every_key_once() -> None:
    paths = [line.split(": ")[0] for line in schema.lines()]
    assert len(paths) == len(set(paths))
    assert {
        "cycle_us",
        "plant.stop.<AXIS>.stiffness_n_per_um",
        "fault[<N>].kind",
        "axis.<AXIS>.<list path>",
    } <= set(paths)
    assert schema.text().endswith("\n")


def test_machine_names_lead_to_the_package() -> None:
    assert data_file("machines", "demo").joinpath("machine.toml").is_file()


@pytest.mark.parametrize(
    "overrides",
    [
        {"plant.probe.Z.face_mm": 1.5},
        {"plant.probe.pretravel_um": 3.0, "plant.cam.X.to_mm": -450.0},
        {"plant.cam.X.from_mm": 100.0},
        {"plant.axis.Y.pitch_mm": 5.0, "axis.Y.start_mm": 7.0},
        {"plant.axis.X.increments_per_turn": 2**31},
        {"axis.Z.start_mm": 1e9},
        {"axis.X.kopf.achs_nr": 2},
        {"axis.Y.node_id": 1},
        {"axis.Y.node_id": 200},
        {"axis.Z.probe_input_1": "cam.X"},
        {"axis.Z.probe_input_1": "cam.Q"},
        {"axis.Z.kenngr.measure.signal": "PLC"},
        {"axis.Z.kenngr.measure.signal": "NONE"},
        {"axis.Z.kenngr.achs_typ": 2},
        {"axis.Z.list": "x.lis"},
        {"axis.Z.list": "none.lis"},
        {"axis.Q.start_mm": 1.0},
        {"channel.messtyp": 7},
        {"channel.messtyp": 70},
        {"seed": 5, "cycle_us": 2000},
        {"cycle_us": 3000, "plc.0.period_us": 4000},
        {"dc_epoch": "2030-01-01T00:00:00Z"},
        {"terminal.probe.wiring.ch1": "cam.X"},
        {"terminal.probe.wiring.ch1": "nothing"},
        {"terminal.probe.period_us": 1500},
        {"plc": []},
        {"axis.X.list": "x.lis", "axis.X.drive": "drives.models.servo402", "axis.X.node_id": 1},
        {"axis.X.list": 5, "axis.X.kenngr.swe_neg": 1},
        {"terminal.probe.model": "EL1252", "terminal.probe.wiring.ch2": "cam.X"},
        {"terminal.probe.wiring.ch2": "bad1", "fault": [{"kind": "probe_stuck", "target": "bad2"}]},
        {"plc": [{"script": "demo.py", "period_us": 4000}]},
        {"plc.0.name": "other", "plc.3.script": "demo.py"},
        {"fault": [{"kind": "probe_stuck", "at_ms": 5.0}], "plant.probe.Z.face_mm": 1.0},
        {"fault.0.kind": "probe_stuck", "fault.0.target": "cam.Z"},
        {"fault.0.kind": "probe_stuck", "fault.0.target": "cam.Q"},
        {"nonsense": 1, "plant.probe.Z.face_mm": "here"},
    ],
    ids=str,
)
def test_what_an_override_leaves_alone_is_kept_and_all_else_is_worked_out(
    overrides: Mapping[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Loading on top of what the same folder gave before comes to what loading all of it does, errors too."""

    def outcome() -> object:
        try:
            return load("demo", overrides)
        except BenchError as error:
            return type(error), str(error)

    plain = load("demo")
    on_top = outcome()
    if isinstance(on_top, MachineConfig):
        assert any(one is other for one, other in zip(on_top.axes, plain.axes, strict=True))
    monkeypatch.setattr(folder, "_plain", lambda *_: None)
    assert on_top == outcome()


def test_a_file_that_changes_is_read_anew(tmp_path: Path) -> None:
    shutil.copytree(data_file("machines", "demo"), tmp_path / "mine")
    file = tmp_path / "mine" / "machine.toml"
    for start_mm in (1.0, 2.0, 3.0):
        file.write_text(re.sub(r"start_mm = [\d.]+", f"start_mm = {start_mm}", file.read_text(), count=1))
        assert start_mm in [axis.start_mm for axis in load(file.parent, {"seed": 1}).axes]


def test_a_list_value_of_minus_zero_stays_with_its_machine(tmp_path: Path) -> None:
    """Equal values that are not the same must not be shared."""
    shutil.copytree(data_file("machines", "demo"), tmp_path / "mine")
    file = tmp_path / "mine" / "x.lis"
    changed, count = re.subn(r"(?m)^(antr\.function\[0\]\.min_limit\s+)0\.0", r"\1-0.0", file.read_text())
    assert count == 1
    file.write_text(changed)
    limits = [load(place).axes[0].params.antr.function[0].min_limit for place in (tmp_path / "mine", "demo")]
    assert [str(limit) for limit in limits] == ["-0.0", "0.0"]


def test_what_is_beside_a_machine_is_looked_at_each_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither another current directory nor a script that comes or goes is hidden by what was loaded before."""
    for name in ("one", "two"):
        shutil.copytree(data_file("machines", "demo"), tmp_path / name)
        monkeypatch.chdir(tmp_path / name)
        assert load(Path(), {"seed": 1}).name == name
    supplied = load(Path(), {"seed": 1}).plcs[0].script
    own = tmp_path / "two" / "demo.py"
    own.write_text("")
    assert load(Path(), {"seed": 1}).plcs[0].script.resolve() == own != supplied
    own.unlink()
    assert load(Path(), {"seed": 1}).plcs[0].script == supplied
    (tmp_path / "two" / "x.lis").unlink()
    with pytest.raises(InputError, match=r"x\.lis"):
        load(Path(), {"seed": 1})


def test_the_text_of_an_old_file_is_kept_while_it_is_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "list.lis"
    file.write_text("one")
    monkeypatch.setattr(texts, "time_ns", lambda: 2**62)
    first = texts.text_of(file)
    assert texts.text_of(file) is first
    file.write_text("three")
    assert texts.text_of(file) == "three"
