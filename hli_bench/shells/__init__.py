"""The only I/O: clocks, processes, SocketCAN, Zenoh, Modbus TCP, files."""
