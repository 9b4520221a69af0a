"""Terminals: wired signals become a process image. One module a terminal type, found by the models it names.

Recipe for a new type, `hli_bench/terminals/<type>.py`:

- `MODELS`: the model names that machine.toml may use.
- `layout(settings) -> TerminalLayout`: name, data type and byte offset of every entry (`ch2/input`).
- `channels(settings) -> tuple[Channel, ...]`: the inputs with signal, delay, latch mode.
- `image(rows) -> bytes`: the process image, little-endian, from this terminal's CHANNEL rows.

`tests/unit/terminals/test_folder.py` walks every module of this folder and says what is incomplete.
"""
