"""`python without_locks.py ERRNO COMMAND ...`: run a command where flock() ends in that error.

By a filter of the kernel's, which all that the command starts has as well.
"""

import ctypes
import errno
import os
import platform
import struct
import sys

FLOCK = {"x86_64": 73, "aarch64": 32}[platform.machine()]
PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, FILTER = 38, 22, 2
LOAD, EQUAL, RETURN = 0x20, 0x15, 0x06  # of BPF
ALLOW, ERROR = 0x7FFF0000, 0x00050000

number = getattr(errno, sys.argv[1])
program = b"".join(
    struct.pack("HBBI", *step)
    for step in [
        (LOAD, 0, 0, 0),  # the number of the call
        (EQUAL, 0, 1, FLOCK),
        (RETURN, 0, 0, ERROR | number),
        (RETURN, 0, 0, ALLOW),
    ]
)
code = ctypes.create_string_buffer(program)
given = struct.pack("HP", 4, ctypes.addressof(code))
libc = ctypes.CDLL(None, use_errno=True)
for call in ((PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), (PR_SET_SECCOMP, FILTER, given, 0, 0)):
    if libc.prctl(*call):
        sys.exit(os.strerror(ctypes.get_errno()))
os.execvp(sys.argv[2], sys.argv[2:])
