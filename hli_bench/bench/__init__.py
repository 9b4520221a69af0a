"""From a machine folder to a running bench: nodes, wiring, schedule, and the public class Bench."""
