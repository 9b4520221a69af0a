"""The machine around the drives: mechanics, workpiece and probe, cam switches, fixed stops."""
