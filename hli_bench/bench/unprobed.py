"""Says of measuring runs that gave an axis no value what they lacked: a face, a PLC that tells of it, a signal."""

from collections import Counter
from collections.abc import Sequence

from hli_bench.bench.config import MachineConfig
from hli_bench.bench.result import NotMeasured
from hli_bench.kernel.records import Unmeasured
from hli_bench.plant.settings import PROBE


def reason(config: MachineConfig, one: Unmeasured) -> str:
    """Return why a measuring run gave an axis no value."""
    if one.fixed_stop:
        return "no fixed stop was found on its way"
    if not has_face(config):
        name = config.axes[one.axis].name
        return f"as the plant has no face: plant.probe.{name}.face_mm and plant.probe.{name}.material set one"
    if one.unserved:
        return f"as no PLC serves {' and '.join(one.unserved)}"
    return "no probing signal came on its way"


def has_face(config: MachineConfig) -> bool:
    """Tell whether anything on the machine can operate the probe."""
    return any(axis.face for axis in config.plant.axes) or any(
        fault.target == PROBE for fault in config.faults
    )


def unmeasured(config: MachineConfig, found: Sequence[Unmeasured]) -> list[NotMeasured]:
    """Return what a result says of the axes that got no value, in order."""
    return [NotMeasured(config.axes[one.axis].name, one.source.name, reason(config, one)) for one in found]


def remarks(config: MachineConfig, found: Sequence[Unmeasured]) -> list[str]:
    """Return a remark for each axis and block that measured nothing.

    What the CNC reports by itself is remarked only where the plant or a PLC is what lacks.
    """
    texts: Counter[str] = Counter()
    for one in found:
        lacking = not one.fixed_stop and (one.unserved or not has_face(config))
        if one.reported and not lacking:
            continue
        why = reason(config, one)
        joint = ", " if why.startswith("as ") else ": "
        texts[f"{one.source.name}: axis {config.axes[one.axis].name} measured nothing{joint}{why}"] += 1
    return [text if times == 1 else f"{text} ({times} times)" for text, times in texts.items()]
