import json
from typing import Any

import pytest

from hli_bench.protocols.hli.access import Access
from hli_bench.protocols.hli.control_unit import ControlUnits
from hli_bench.protocols.hli.image import Image
from hli_bench.protocols.hli.layout import Layout
from hli_bench.wire.hli import Commands, Write
from hli_bench.wire.images import size_of

PROBE = "ax/1/lr_mc_control/probing_signal"
FEED = "ax/1/lr_mc_control/release_feedhold"


class Machine:
    def __init__(self) -> None:
        self.image = Image(Layout([(1, "X", "linear"), (2, "Y", "linear")]))
        self.access = Access(self.image)
        self.units = ControlUnits(self.image, {"release_feedhold": True})

    def write(self, path: Any, value: Any, plc: Any = "plc") -> None:
        assert self.access.apply(Commands(plc, 1, (Write(path, value),))) == []

    def read(self, path: Any) -> Any:
        return self.image.get(self.image.layout.element(path).id)


@pytest.fixture
def machine() -> Machine:
    machine = Machine()
    machine.write("ax/1/head/plc_present_w", True)
    machine.units.sample()
    return machine


@pytest.mark.req("M-237")
def test_a_command_counts_only_with_enable(machine: Any) -> None:
    machine.write(f"{PROBE}/command_w", True)
    assert machine.units.sample() == []
    assert machine.units[PROBE].effective is False
    machine.write(f"{PROBE}/enable_w", True)
    assert machine.units.sample() == [machine.units[PROBE]]
    assert machine.units[PROBE].effective is True
    assert machine.units[PROBE].redirected


def test_a_write_counts_from_the_next_sampling_on(machine: Any) -> None:
    machine.write(f"{PROBE}/enable_w", True)
    machine.units.sample()
    machine.write(f"{PROBE}/command_w", True)
    assert machine.units[PROBE].effective is False
    machine.units.sample()
    assert machine.units[PROBE].effective is True


def test_a_signal_that_came_and_went_between_two_samplings_is_not_seen(machine: Any) -> None:
    machine.write(f"{PROBE}/enable_w", True)
    machine.units.sample()
    machine.write(f"{PROBE}/command_w", True)
    machine.write(f"{PROBE}/command_w", False)
    assert machine.units.sample() == []


def test_without_redirection_the_gui_acts_and_request_is_not_supplied(machine: Any) -> None:
    machine.units[FEED].ask(False)
    assert machine.units[FEED].effective is False
    assert machine.read(f"{FEED}/request_r") is False
    machine.units[FEED].ask(True)
    assert machine.units[FEED].effective is True
    assert machine.read(f"{FEED}/request_r") is False


def test_under_redirection_a_wish_waits_in_request_until_the_plc_lets_it_through(machine: Any) -> None:
    machine.write(f"{FEED}/enable_w", True)
    machine.units.sample()
    assert machine.units[FEED].effective is False
    assert machine.read(f"{FEED}/request_r") is True
    machine.write(f"{FEED}/command_w", machine.read(f"{FEED}/request_r"))
    machine.units.sample()
    assert machine.units[FEED].effective is True
    machine.units[FEED].ask(False)
    assert machine.read(f"{FEED}/request_r") is False
    assert machine.units[FEED].effective is True


def test_after_redirection_the_gui_counts_again(machine: Any) -> None:
    for member in ("enable_w", "command_w"):
        machine.write(f"{FEED}/{member}", True)
    machine.units.sample()
    machine.units[FEED].ask(False)
    machine.write(f"{FEED}/enable_w", False)
    machine.units.sample()
    assert machine.units[FEED].effective is False
    assert machine.read(f"{FEED}/request_r") is False


def test_state_is_what_the_cnc_acknowledges(machine: Any) -> None:
    machine.write(f"{PROBE}/enable_w", True)
    machine.write(f"{PROBE}/command_w", True)
    machine.units.sample()
    assert machine.read(f"{PROBE}/state_r") is False
    machine.units[PROBE].acknowledge(True)
    assert machine.read(f"{PROBE}/state_r") is True


def test_units_of_an_area_count_only_with_its_plc_present(machine: Any) -> None:
    unit = "ax/2/lr_mc_control/probing_signal"
    for member in ("enable_w", "command_w"):
        machine.write(f"{unit}/{member}", True)
    machine.units.sample()
    assert not machine.units[unit].redirected
    machine.write("ax/2/head/plc_present_w", True)
    assert machine.units.sample() == [machine.units[unit]]
    assert machine.units[unit].effective is True
    machine.write("ax/2/head/plc_present_w", False)
    assert machine.units.sample() == [machine.units[unit]]
    assert machine.units[unit].effective is False


def test_when_its_plc_leaves_a_unit_falls_back_to_the_gui(machine: Any) -> None:
    for member in ("enable_w", "command_w"):
        machine.write(f"{PROBE}/{member}", True)
    machine.units.sample()
    assert PROBE in machine.access.leave("plc")
    machine.units.sample()
    assert not machine.units[PROBE].redirected
    assert machine.read(f"{PROBE}/enable_w") is False
    assert machine.units[PROBE].effective is False


def test_every_unit_is_known_by_its_old_name_too(machine: Any) -> None:
    assert machine.units["ax/1/MCControlBoolUnit_ProbingSignal"] is machine.units[PROBE]


def test_a_unit_with_usage_check_takes_its_command_once_for_each_semaphor() -> None:
    members = [
        ("request_r", "SGN32", "r"),
        ("enable_w", "BOOL", "w"),
        ("command_w", "SGN32", "w"),
        ("state_r", "SGN32", "r"),
        ("command_semaphor_rw", "BOOL", "rw"),
    ]
    rows = [
        ("ch/1/head/plc_present_w", "BOOL", "w"),
        *((f"ch/1/area/order/{m}", t, a) for m, t, a in members),
    ]
    image = Image(
        Layout.from_json(
            json.dumps(
                [
                    {
                        "id": n,
                        "path": path,
                        "type": t,
                        "unit": "",
                        "offset": 8 * n,
                        "size": size_of(t),
                        "access": a,
                    }
                    for n, (path, t, a) in enumerate(rows)
                ]
            )
        )
    )
    units, unit = ControlUnits(image, {}), "ch/1/area/order"

    def write(**values: int) -> list[int | bool]:
        for member, value in values.items():
            image.write(image.layout.element(f"{unit}/{member}").id, value)
        return [sampled.effective for sampled in units.sample()]

    image.write(0, True)
    write(enable_w=True)
    assert write(command_w=5) == []
    assert write(command_semaphor_rw=True) == [5]
    assert image.get(image.layout.element(f"{unit}/command_semaphor_rw").id) is False
    assert write(command_w=6) == []
    assert write(command_w=5, command_semaphor_rw=True) == [5]
