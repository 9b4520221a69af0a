"""The HLI as bytes and rules: layout, image, control units, who may write what. No I/O."""
