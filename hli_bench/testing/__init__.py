"""pytest plugin: the fixture `bench`."""
