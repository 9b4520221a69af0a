"""The net under every change: runs compared with a commit, and random benches held against what must never happen."""
