%lines
N10 G01 X1 \
N20     Y2 F100
#DRIVE WR SYN [AX=Z KEY=TORQUE_LIMIT \ ; goes on
               VAL=10 WAIT]
N30 Z3 ( outer ( inner ) still comment ) X4
N40 X5 (* as the fixed stop manual writes it *) Y5
N50 X6 ( open to the end Y7
#COMMENT BEGIN
N60 X9999 $$$ anything
#COMMENT END
N70 Z7
M30
