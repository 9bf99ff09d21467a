"""A pseudo-terminal that stands for a serial port."""
import os
import time
import tty


class SerialTerminal:
    """The port has the name `name`; `sensor` is the other side, where a sensor or another program is."""

    def __init__(self):
        self.sensor, self.port = os.openpty()
        tty.setraw(self.port)
        self.name, self.lost = os.ttyname(self.port), 0

    def send(self, data):
        """Waits until everything has room."""
        while data:
            data = data[os.write(self.sensor, data):]

    def send_for(self, data, seconds):
        """What finds no room for so long is lost, as on a wire, and counted in `lost`. The sensor's side must not block."""
        until = time.monotonic() + seconds
        while data:
            try:
                data = data[os.write(self.sensor, data):]
            except BlockingIOError:
                if time.monotonic() > until:
                    self.lost += len(data)
                    return
                time.sleep(0.001)
