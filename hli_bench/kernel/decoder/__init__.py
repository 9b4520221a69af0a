"""The first stage: NC text in, frozen blocks and queries out."""

from hli_bench.kernel.decoder.configuration import DecoderAxis, DecoderDefaults
from hli_bench.kernel.decoder.decoder import WITHOUT_MOTION, Decoder

__all__ = ["WITHOUT_MOTION", "Decoder", "DecoderAxis", "DecoderDefaults"]
