import struct
from typing import Any

import pytest

from hli_bench.plc.names import Frame, Hli, io_root
from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.images import TerminalLayout

LAYOUT = Layout([(1, "X", "linear"), (3, "Z", "linear")])
PROBE = TerminalLayout(
    "probe", (("ch1/input", "BOOL", 0), ("ch2/input", "BOOL", 1), ("ch2/latch_pos", "UNS64", 8))
)


class Program:
    def __init__(self) -> None:
        self.image = Image(LAYOUT)
        self.frame = Frame(LAYOUT)
        self.hli = Hli(self.frame)
        self.frame.begin(self.image.data)

    def changes(self) -> Any:
        return {LAYOUT.elements[number].path: value for number, value in self.frame.take_changes().items()}


@pytest.fixture
def program() -> Program:
    return Program()


def test_a_member_is_read_from_the_image_of_the_cycle(program: Any) -> None:
    state = LAYOUT.element("ax/3/lr_mc_control/timestamp/state_r")
    program.image.set(state.id, -12)
    assert program.hli.ax[3].lr_mc_control.timestamp.state_r == -12
    assert program.hli.ax[1].lr_mc_control.timestamp.state_r == 0


def test_a_written_member_reads_back_at_once_and_becomes_a_command(program: Any) -> None:
    unit = program.hli.ax[3].lr_mc_control.probing_signal
    unit.command_w = True
    assert unit.command_w is True
    assert program.changes() == {"ax/3/lr_mc_control/probing_signal/command_w": True}


def test_only_what_differs_from_the_last_writing_becomes_a_command(program: Any) -> None:
    unit = program.hli.ax[1].lr_mc_control.timestamp
    for value, expected in ((0, 1), (0, 0), (5, 1), (5, 0)):
        program.frame.begin(program.image.data)
        unit.command_w = value
        assert len(program.changes()) == expected


def test_a_flag_of_both_sides_is_compared_with_the_image(program: Any) -> None:
    please = LAYOUT.element("ax/1/ext_latch/please_rw").id
    for _ in range(2):
        program.image.set(please, True)
        program.frame.begin(program.image.data)
        assert program.hli.ax[1].ext_latch.please_rw is True
        program.hli.ax[1].ext_latch.please_rw = False
        assert program.hli.ax[1].ext_latch.please_rw is False
        assert program.changes() == {"ax/1/lr_mc_control/ext_latch_control/please_rw": False}
        program.image.set(please, False)
        program.frame.begin(program.image.data)
        program.hli.ax[1].ext_latch.please_rw = False
        assert program.changes() == {}


def test_old_names_mean_the_same_member(program: Any) -> None:
    program.hli.ax[1].MCControlBoolUnit_ProbingSignal.X_Command = True
    assert program.hli.ax[1].lr_mc_control.MCControlBoolUnit_ProbingSignal.X_Command is True
    assert program.changes() == {"ax/1/lr_mc_control/probing_signal/command_w": True}


@pytest.mark.parametrize(
    ("access", "message"),
    [
        (
            lambda hli: hli.ax[1].lr_mc_control.probing_sginal,
            "'probing_sginal' in ax/1/lr_mc_control; near names: prob",
        ),
        (
            lambda hli: hli.ax[1].lr_mc_control.timestamp.comand_w,
            "'comand_w' in .*timestamp; near names: command_w",
        ),
        (
            lambda hli: setattr(hli.ax[1].lr_mc_control.timestamp, "comand_w", 1),
            "'comand_w' in .*near names: command_w",
        ),
        (
            lambda hli: setattr(hli.ax[1].lr_mc_control, "timestamp", 1),
            "ax/1/lr_mc_control/timestamp is a structure; write one of its members: command_w",
        ),
        (lambda hli: hli.axis, "'axis' in hli"),
        (lambda hli: setattr(hli.ax[1].lr_mc_control.timestamp, "state_r", 1), "only read"),
    ],
)
def test_a_wrong_name_is_told_with_its_path_and_near_names(program: Any, access: Any, message: Any) -> None:
    with pytest.raises(AttributeError, match=message):
        access(program.hli)
    assert program.changes() == {}


def test_a_structure_has_no_value(program: Any) -> None:
    assert repr(program.hli.ax[1].lr_state) == "<ax/1/lr_state>"
    for structure in (program.hli.ax[1].lr_mc_control.timestamp, io_root([PROBE])[0].probe.ch2):
        with pytest.raises(TypeError, match=" is a structure and has no value; it has "):
            bool(structure)


def test_a_missing_axis_is_told_with_those_there_are(program: Any) -> None:
    with pytest.raises(KeyError, match=r"no ax\[2\] on this machine; there are 1, 3"):
        program.hli.ax[2]


@pytest.mark.parametrize(("member", "value"), [("command_w", 2**63), ("command_w", 1.5), ("enable_w", 7)])
def test_a_value_that_does_not_fit_its_type_is_told(program: Any, member: Any, value: Any) -> None:
    with pytest.raises(ValueError, match=r"ax/1/lr_mc_control/timestamp/.* is no "):
        setattr(program.hli.ax[1].lr_mc_control.timestamp, member, value)


def test_dir_lists_what_is_inside(program: Any) -> None:
    assert dir(program.hli.ax[1].lr_mc_control.timestamp) == ["command_w", "enable_w", "request_r", "state_r"]
    assert "probing_signal" in dir(program.hli.ax[1].lr_mc_control)


def test_io_reads_the_image_of_its_terminal() -> None:
    io, holders = io_root([PROBE, TerminalLayout("cams", (("ch1/input", "BOOL", 0),))])
    assert io.probe.ch2.latch_pos == 0
    holders["probe"].data = struct.pack("<??6xQ", False, True, 2**63 + 5)
    assert (io.probe.ch1.input, io.probe.ch2.input, io.probe.ch2.latch_pos) == (False, True, 2**63 + 5)
    assert io.cams.ch1.input is False


@pytest.mark.parametrize(
    ("access", "message"),
    [
        (lambda io: io.prob, "'prob' in io; near names: probe"),
        (lambda io: io.probe.ch3, "'ch3' in io/probe; near names: ch"),
        (lambda io: io.probe.ch2.inputs, "'inputs' in io/probe/ch2; near names: input"),
        (lambda io: setattr(io.probe.ch2, "input", 1), "io/probe/ch2/input is an input"),
        (lambda io: setattr(io.probe.ch2, "inpt", 1), "'inpt' in io/probe/ch2"),
    ],
)
def test_a_wrong_entry_is_told_with_near_names(access: Any, message: Any) -> None:
    with pytest.raises(AttributeError, match=message):
        access(io_root([PROBE])[0])


def test_an_axis_is_found_by_its_name_here_and_in_paths() -> None:
    layout = Layout.from_json(Layout([(3, "Z", "linear"), (5, "x2", "rotary")]).to_json())
    frame = Frame(layout)
    hli = Hli(frame)
    frame.begin(bytes(layout.size))
    assert hli.ax.Z is hli.ax.z is hli.ax[3]
    assert hli.ax.X2 is hli.ax[5]
    assert layout.resolve("ax/Z/lr_mc_control/probing_signal") == "ax/3/lr_mc_control/probing_signal"
    assert layout.element("AX/X2/lr_mc_control/probing_signal/command_w").path.startswith("ax/5/")
    with pytest.raises(AttributeError, match=r"no 'Y' in ax; there are 3, 5, by name Z, X2"):
        _ = hli.ax.Y
    with pytest.raises(AttributeError, match=r"no 'Z' in ch; there are 1"):
        _ = hli.ch.Z
