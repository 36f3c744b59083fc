"""The words of the page that `gpu/page.py` makes; numbers in braces come from the rows."""

ANSWER = """# Would a GPU make fits faster?

{answer}

This page is made by `python benchmarks/gpu_speed.py --out benchmarks/results/gpu.jsonl` from the
rows there; it is not written by hand. Measured on {date} on one {device} and on
{cores} cores of its host ({host}), with {versions}.

## Times

A step is a Runge-Kutta step of 1 ms, which evaluates the accelerations four times. A *world* is
one simulation: a fit simulates one or two for each free parameter, 20 to 600 side by side, over
2000 to 20 000 steps that follow one another. So the time of one step of all worlds counts, and
below some width a GPU is not busy: its time does not fall with fewer worlds. Compiling is not in
the times; JAX compiles each number of worlds and of steps anew, in {mjx} s here; the CUDA kernel
took {kernel} s and the first model in MuJoCo Warp {warp} s. Of what was measured more than once
the least time counts; others were up to {spread} % longer on the processor, {spread_gpu} % on the
GPU. The angles stay on the GPU; on the processor they are in the memory of the program.

Time of one step of all worlds, with the law of the drives [µs]; what is empty was not measured:
"""
TAKES = """
## What it would take

- **MJX** has no callbacks and refuses actuators of the type "user". What is there: a Runge-Kutta
  step of one's own around `fwd_position`, `fwd_velocity`, `fwd_actuation` and `fwd_acceleration`,
  with the forces in `qfrc_applied` (`benchmarks/gpu/mjx.py`). It agrees with the twin to rounding
  in float64. The tendons' Jacobian and rates that it reads are private to MJX. All candidate
  effects would have to be written a second time, in JAX, and users' own effects too.
- **MuJoCo Warp** does have callbacks: `Model.callback.passive`, `.act_dyn`, `.act_bias` and
  others are Python functions that launch kernels, and a CUDA graph keeps these
  (`benchmarks/gpu/warp.py`). Its arrays are float32. It refuses the flag that switches MuJoCo's
  automatic reset off, and it does not integrate activations of the type "user"; those of the type
  "integrator", with the rate written by the callback, it does.
- **A kernel of the project's own** is what could pay (`benchmarks/gpu/kernel.py`): platform,
  cables and drums as one function of 100 lines, one thread a world, all steps in one launch, in
  float64. The law is compiled from the same source as the twin's, by numba, and effects are
  compiled functions already, so that they could be composed into it in the same way. It is the
  INCA alone: another robot, which is an MJCF file, has no such function. The rest of a fit stays
  on the processor: bare steps were 70 % of a fit's processor time and 35 % of a discovery's in
  the row 9956938 of [speed](speed.md). Steps that cost nothing would make the first three times
  as fast at most, the second one and a half times.

## What was not measured

- A whole fit or discovery on a GPU: there is none. Nor outputs that are copied back to the host.
- Candidate effects on a GPU, limits of currents, or a load off the centre of mass.
- Several threads for one world, which would shorten the step of the kernel.
- Larger steps of the differences in float32, which divide its rounding less and curve more, and
  derivatives by JAX, which divide nothing. Neither are the columns that fits use.
- Other GPUs. Consumer cards compute float64 at a small share of the speed of float32.

## To measure it

    pip install "jax[cuda13]" mujoco-mjx==3.17.0 mujoco-warp==3.17.0 "numba-cuda[cu13]" "numpy<2.5"
    python benchmarks/gpu_speed.py --out benchmarks/results/gpu.jsonl

The project does not depend on these packages. numba-cuda 0.30.4 asks numpy for a name that numpy
2.5 no longer has; for the rows here, with numpy 2.5.2, `numpy.row_stack` was put back by hand.
"""
SHORT = """**A GPU hardly helps the fits of this program today.** MJX can compute the robot with
its law in float64. A step of 32 worlds then takes {mjx_32:.0f} µs, where MuJoCo takes
{two_32:.0f} µs on two cores; a step of 256 worlds takes {mjx_256:.0f} µs, where MuJoCo takes
{two_256:.0f} µs on two cores and {all_256:.0f} µs on {cores}. MJX is faster than two cores from
{from_two} worlds on, and faster than {cores} from {from_all}. A fit simulates 20 to 600 worlds
side by side, a sweep more. MuJoCo Warp computes in float32 only, which is of no use to a fit:
with the differences that fits use, its best column of the Jacobian is wrong by {wrong:.0f} %. A
kernel that is written for the INCA alone would pay. The robot and its law as one function in
float64 take {kernel_32:.0f} µs for 32 worlds, {kernel_256:.0f} µs for 256 and {kernel_widest:.0f}
µs for {widest}, which is {times:.0f} times as fast as {cores} cores. That kernel is a benchmark
and no part of the program: it knows no other robot and no candidate effects."""
ACCURACY = """
## Accuracy

Two seconds of PRBS from rest, beside the twin on the processor: a free run, and columns of the
Jacobian by differences of a relative step of 1e-4 (central) and 1e-6 (forward), as searches use
them. The error of a column is relative to the twin's central difference, rms over the record; the
table has the least and the largest of nine parameters. The largest errors in float64 are those of
parameters that the record hardly tells, such as the damping b of the cables. An encoder with its
noise errs by 0.67 mrad, so that float32 would do for a free run. In float64 the columns are as
good as the processor's own, whose forward differences err by as much. In float32 an angle of a
few rad is rounded by 1e-7 rad, and a difference divides what the steps make of this by 1e-4 or
1e-6.
"""
