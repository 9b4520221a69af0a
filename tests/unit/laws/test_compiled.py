"""Calling a law without looking for the types of its arguments."""

import numpy as np
import pytest

from hli_bench.laws.compiled import straight
from hli_bench.laws.publish import publish_positions
from hli_bench.laws.rows import AXIS


def test_a_law_that_is_called_straight_is_the_same_law_and_refuses_other_types() -> None:
    axis, image, offsets = np.zeros(2, AXIS), np.zeros(24, np.uint8), np.array([0, 12])
    axis["actual"] = 10.4, -3.0
    straight(publish_positions, axis, image, offsets)(axis, image, offsets)
    by_law = np.zeros(24, np.uint8)
    publish_positions(axis, by_law, offsets)
    assert image.tobytes() == by_law.tobytes()
    assert int.from_bytes(image[:4].tobytes(), "little") == 10
    with pytest.raises(TypeError):
        straight(publish_positions, axis, image, offsets)(axis, image.astype(float), offsets)
