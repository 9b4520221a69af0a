"""CANopen (CiA 301, 305, 306) without I/O: dictionary, SDO, PDO, NMT, EMCY, LSS, the slave made of them."""
