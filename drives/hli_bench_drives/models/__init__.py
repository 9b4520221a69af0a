"""Drive models: one module each, named in a machine folder by its module path."""
