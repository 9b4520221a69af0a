"""Drive management: start-up of the nodes, drive states, acyclic drive objects."""
