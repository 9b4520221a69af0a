"""Emulated drives: profiles and models made of them. A user's own drive is one module like `models.*`."""
