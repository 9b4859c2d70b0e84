"""The question of the README: a pose from three tendon lengths, and a pose out of reach."""
import sinew

robot = sinew.load("3-rfr")  # or a file: "robots/3-rfr.yaml"

pose = robot.forward([0.193, 0.189, 0.187]).pose  # SI and radians
print(f"x {1e3 * pose.x:.3f} mm, y {1e3 * pose.y:.3f} mm, phi {pose.phi:.4f} rad")

far = robot.inverse({"x": "300 mm", "y": 0, "phi": 0})
if not far.ok:
    print(f"{far.status}: {far.message}")

# Prints:
#   x 12.079 mm, y -17.443 mm, phi 0.1385 rad
#   unreachable: legs[0] needs a chord of 380.895 mm, its backbone is 200 mm long
