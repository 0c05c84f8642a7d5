"""An engine of 30 lines, judged: python3 examples/other_engine.py setups/limit_cycle.json mine/limit_cycle.csv [STEPS_PER_SAMPLE]"""
import json, sys

setup = json.load(open(sys.argv[1]))
mass, K, D, elements, start = (setup[key] for key in ("mass", "stiffness", "damping", "jenkins", "start"))
n, per_sample = len(mass), int(sys.argv[3]) if len(sys.argv) > 3 else 16
h = setup["interval"] / per_sample
x, v, f = list(start["positions"]), list(start["velocities"]), list(start["slider_forces"])

def acceleration(x, v, f):
    force = [-sum(K[i][j] * x[j] + D[i][j] * v[j] for j in range(n)) for i in range(n)]
    force[0] -= sum(element["slip_force"] * value for element, value in zip(elements, f))
    return [force[i] / mass[i] for i in range(n)]

a = acceleration(x, v, f)
with open(sys.argv[2], "w") as out:
    out.write(",".join(["t"] + [f"{name}{i + 1}" for name in "xv" for i in range(n)]) + "\n")
    for sample in range(round(setup["t_end"] / setup["interval"]) + 1):
        out.write(",".join(repr(value) for value in [sample * setup["interval"], *x, *v]) + "\n")
        for _ in range(per_sample):  # leapfrog with the velocity predicted for the damping
            half = [v[i] + h / 2 * a[i] for i in range(n)]
            moved = [x[i] + h * half[i] for i in range(n)]
            for j, element in enumerate(elements):  # the slider follows mass 1 and slips at its limit
                rise = element["stiffness"] / element["slip_force"] * (moved[0] - x[0])
                f[j] = max(-1.0, min(1.0, f[j] + rise))
            x = moved
            a = acceleration(x, [half[i] + h / 2 * a[i] for i in range(n)], f)
            v = [half[i] + h / 2 * a[i] for i in range(n)]
