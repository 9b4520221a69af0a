"""Sans-IO protocols (CANopen, HLI, Modbus): frames in, frames out, time as an argument; mutually unaware."""
