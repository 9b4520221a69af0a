%probe
; Measures the face below Z, then takes Z to 10 mm above it by the measured offset.
N10 #MEAS MODE[1]
N20 G90 G01 Z200 F6000
N30 G100 Z20 F500
N40 #MSG SYN["V.A.MESS.Z=%f", V.A.MESS.Z]
N50 #MSG SYN["V.A.MOFFS.Z=%f", V.A.MOFFS.Z]
N60 #MSG SYN["V.A.MERF.Z=%d", V.A.MERF.Z]
N70 G101 Z1
N80 G01 Z30 F6000
N90 #MSG SYN["V.A.ABS.Z=%f", V.A.ABS.Z]
N100 G102 Z1
N110 G01 Z200
N120 M30
