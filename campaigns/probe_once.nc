%probe_once
; One measuring run down to the face below Z, with the feed that a campaign gives; see docs/sweeps.md.
N10 #MEAS MODE[1]
N20 G90 G01 Z290 F6000
N30 G100 Z0 F{feed}
N40 M30
