%
(a plate with a round corner, a concave corner and a straight edge; millimetres)
N10 G21 G90 G17
N20 M3 S12000
N30 G0 X100 Y0
N40 G1 X300 F1500
N50 G3 X400 Y100 I0 J100
N60 G1 Y200
N70 G2 X300 Y300 R100
N80 G1 X-100
N90 G0 X0 Y0
N100 M5
N110 M30
