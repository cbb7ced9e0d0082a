"""A controller in Python by ctypes, as a test of the shared library. Arguments: the library, a robot file."""

import ctypes
import math
import sys

library = ctypes.CDLL(sys.argv[1])


class PoseInput(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("position_m", ctypes.c_double * 3),
        ("quaternion_wxyz", ctypes.c_double * 4),
        ("velocity_m_s", ctypes.c_double * 3),
        ("angular_velocity_rad_s", ctypes.c_double * 3),
        ("acceleration_m_s2", ctypes.c_double * 3),
        ("angular_acceleration_rad_s2", ctypes.c_double * 3),
        ("force_n", ctypes.c_double * 3),
        ("moment_n_m", ctypes.c_double * 3),
    ]


Row = ctypes.POINTER(ctypes.c_double)


class InverseResult(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("cables", ctypes.c_uint32),
        ("status", ctypes.c_int32),
        ("iterations", ctypes.c_int32),
        ("age_calls", ctypes.c_int32),
        ("least_margin_cable", ctypes.c_int32),
        ("least_margin_n", ctypes.c_double),
        ("error_n", ctypes.c_double),
        ("error_m", ctypes.c_double),
        ("length_m", Row),
        ("length_rate_m_s", Row),
        ("length_acceleration_m_s2", Row),
        ("free_length_m", Row),
        ("tension_platform_n", Row),
        ("tension_drum_n", Row),
        ("margin_n", Row),
    ]


assert library.fn_abi_version() == 1
message = ctypes.create_string_buffer(4000)
model, loop = ctypes.c_void_p(), ctypes.c_void_p()
status = library.fn_model_from_file(sys.argv[2].encode(), ctypes.byref(model), message, ctypes.c_size_t(4000))
assert status == 0, message.value.decode()
size, alignment = ctypes.c_size_t(), ctypes.c_size_t()
assert library.fn_loop_bytes(model, ctypes.byref(size), ctypes.byref(alignment)) == 0
memory = ctypes.create_string_buffer(size.value + alignment.value)
start = -ctypes.addressof(memory) % alignment.value
place = ctypes.c_void_p(ctypes.addressof(memory) + start)
assert library.fn_loop_init(model, place, size, ctypes.byref(loop)) == 0
assert library.fn_warm_up(loop) == 0

lengths, tensions = (ctypes.c_double * 16)(), (ctypes.c_double * 16)()
result = InverseResult(ctypes.sizeof(InverseResult), 16)
result.length_m = ctypes.cast(lengths, Row)
result.tension_drum_n = ctypes.cast(tensions, Row)
pose = PoseInput(ctypes.sizeof(PoseInput))
pose.quaternion_wxyz[0] = 1.0
pose.position_m[2] = 1.5
for tick in range(100):
    pose.position_m[0] = 1e-3 * tick
    assert library.fn_inverse(loop, ctypes.byref(pose), ctypes.byref(result)) == 0
assert result.least_margin_n > 0.0 and min(tensions[:8]) > 0.0
last = lengths[0]

pose.position_m[0] = math.nan
assert library.fn_inverse(loop, ctypes.byref(pose), ctypes.byref(result)) == -1
assert lengths[0] == last
assert library.fn_model_free(model) == -8
assert library.fn_loop_end(loop) == 0 and library.fn_model_free(model) == 0
print(f"Python: {last:.6f} m")
