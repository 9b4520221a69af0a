"""The manuals as tables: parameters, errors, NC variables, HLI elements. Data and checks, no behaviour."""
