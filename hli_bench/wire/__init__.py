"""Frozen messages between nodes: CAN frames, process images, HLI elements, signal edges. No behaviour."""
