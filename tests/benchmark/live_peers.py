# SPDX-License-Identifier: MIT
"""What live_soak.py puts around `live`: a ZeroMQ subscriber, a viewer of its page, and a relay before its source."""

import ctypes
import json
import socket
import threading
import time
import urllib.parse

import numpy


class Subscriber:
    """ZeroMQ's C interface, as far as a subscriber needs it."""

    def __init__(self, address):
        self.zmq = ctypes.CDLL("libzmq.so.5")
        self.zmq.zmq_ctx_new.restype = self.zmq.zmq_socket.restype = ctypes.c_void_p
        context = ctypes.c_void_p(self.zmq.zmq_ctx_new())
        self.socket = ctypes.c_void_p(self.zmq.zmq_socket(context, 2))  # SUB
        self.zmq.zmq_setsockopt(self.socket, 6, b"posture", 7)  # SUBSCRIBE
        timeout = ctypes.c_int(200)
        self.zmq.zmq_setsockopt(self.socket, 27, ctypes.byref(timeout), 4)  # RCVTIMEO
        self.zmq.zmq_connect(self.socket, address.encode())
        self.buffer = ctypes.create_string_buffer(1 << 20)

    def part(self):
        size = self.zmq.zmq_recv(self.socket, self.buffer, len(self.buffer), 0)
        return None if size < 0 else self.buffer.raw[:size]

    def message(self):
        """Header and arrays by name; None: nothing came."""
        if self.part() is None:
            return None
        header, data = json.loads(self.part()), self.part()
        arrays, at = {}, 0
        for field in header["fields"]:
            kind = numpy.dtype({"f64": "<f8", "u8": "u1"}[field["dtype"]])
            count = int(numpy.prod(field["shape"]))
            arrays[field["name"]] = numpy.frombuffer(data, kind, count, at).reshape(field["shape"])
            at += count * kind.itemsize
        return header, arrays


class Relay:
    """TCP from a port of its own to another one; may be closed and silent."""

    def __init__(self, target):
        self.target, self.port, self.silent = target, 0, False
        self.open()

    def open(self):
        self.listener = socket.socket()
        self.listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.listener.bind(("127.0.0.1", self.port))
        self.port = self.listener.getsockname()[1]
        self.listener.listen()
        self.sockets = []
        threading.Thread(target=self.accept, args=(self.listener,), daemon=True).start()

    def close(self):
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        for one in self.sockets:
            try:
                one.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def accept(self, listener):
        while True:
            try:
                client, _ = listener.accept()
            except OSError:
                return
            try:
                server = socket.create_connection(("127.0.0.1", self.target))
            except OSError:
                client.close()
                continue
            self.sockets = [s for s in self.sockets if s.fileno() >= 0] + [client, server]
            ends = threading.Lock()
            for source, sink in ((client, server), (server, client)):
                source.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                threading.Thread(target=self.pass_on, args=(source, sink, ends), daemon=True).start()

    def pass_on(self, source, sink, first_to_end):
        try:
            while data := source.recv(1 << 16):
                while self.silent:
                    time.sleep(0.01)
                sink.sendall(data)
        except OSError:
            pass
        if first_to_end.acquire(blocking=False):
            for one in (source, sink):
                try:
                    one.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass
        else:
            source.close()
            sink.close()


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def open_viewer(address):
    """A WebSocket of the page, as a browser opens it."""
    parts = urllib.parse.urlsplit(address)
    viewer = socket.create_connection((parts.hostname, parts.port))
    viewer.sendall(f"GET {parts.path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    return viewer
