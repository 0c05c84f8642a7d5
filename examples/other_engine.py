"""An engine of 30 lines, judged: python3 examples/other_engine.py setups/limit_cycle.json mine/limit_cycle.csv [STEPS_PER_SAMPLE]"""
import json, math, sys

setup = json.load(open(sys.argv[1]))
mass, K, D, elements, start, hand = (setup[key] for key in ("mass", "stiffness", "damping", "jenkins", "start", "prescribed"))
n, per_sample = len(mass), int(sys.argv[3]) if len(sys.argv) > 3 else 16
force, h = setup["force"] or [0.0] * n, setup["interval"] / per_sample
x, v, f = list(start["positions"]), list(start["velocities"]), list(start["slider_forces"])

def acceleration(x, v, f):
    total = [force[i] - sum(K[i][j] * x[j] + D[i][j] * v[j] for j in range(n)) for i in range(n)]
    total[0] -= sum(element["slip_force"] * value for element, value in zip(elements, f))
    return [total[i] / mass[i] for i in range(n)]

a = acceleration(x, v, f)
with open(sys.argv[2], "w") as out:
    out.write(",".join(["t"] + [f"{name}{i + 1}" for name in "xv" for i in range(n)] + [f"f{j + 1}" for j in range(len(f))]) + "\n")
    for sample in range(round(setup["t_end"] / setup["interval"]) + 1):
        out.write(",".join(repr(value) for value in [sample * setup["interval"], *x, *v, *f]) + "\n")
        for step in range(1, per_sample + 1):  # leapfrog with the velocity predicted for the damping
            half = [v[i] + h / 2 * a[i] for i in range(n)]
            moved = [x[i] + h * half[i] for i in range(n)]
            if hand:  # moved by hand: the equation of motion is not asked
                i, phase = hand["oscillator"] - 1, hand["angular_frequency"] * (sample * setup["interval"] + step * h)
                moved[i] = hand["amplitude"] * math.sin(phase)
            for j, element in enumerate(elements):  # the slider follows mass 1 and slips at its limit
                rise = element["stiffness"] / element["slip_force"] * (moved[0] - x[0])
                f[j] = max(-1.0, min(1.0, f[j] + rise))
            x = moved
            a = acceleration(x, [half[i] + h / 2 * a[i] for i in range(n)], f)
            v = [half[i] + h / 2 * a[i] for i in range(n)]
            if hand:
                v[i] = hand["amplitude"] * hand["angular_frequency"] * math.cos(phase)
