"""Written by tools/python_stubs.py of _fields.py."""
from collections.abc import Mapping, Sequence
from typing import Any

from ._types import Lists, Number, Numbers, Pose
from .answer import Answer

class Verbs:
    def forward(
        self,
        inputs: Numbers | None = None,
        *,
        configuration: Lists | None = None,
        changes: Lists | None = None,
        slack: Numbers | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        start: Any | None = None,
        want: Sequence[str] | None = None,
        with_respect_to: Sequence[str] | None = None,
        until: Mapping[str, Any] | None = None,
        posture_threshold: Number | None = None,
        all: bool | None = None,
        trace: bool | None = None,
        model: str | None = None,
        law: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Pose of the platform or tip from the inputs.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            inputs [m, rad]: what the motors command, in the order of robot.inputs: (k,), or (n, k) for n
                rows
            configuration [rad, m]: of serial robots: the bend of each section, [theta, phi] or [beta_1,
                beta_2]
            changes [m]: of serial robots: length paid out, a list a section, a value a tendon
            slack [m]: beside `configuration`: a length a section, paid out to all its tendons
            wrench [N, N m]: of the world on the platform, about its reference point, in base axes: (fx, fy,
                m) or (6,)
            gravity [m/s^2]: in place of the robot's, in base axes, (3,)
            start: where the search begins: a pose, inputs, or "last", the last answer to this thread
            want: more to be answered: stiffness, stability, margins, sensitivity, shape, velocity, ...
            with_respect_to: paths of the robot's numbers by which `sensitivity` is taken, too
            until: {wrench, limit}: this load is added, up to `limit` times
            posture_threshold [rad]: largest turn of a joint for which the linear model counts as valid
            all: every solution: `solutions`
            trace: the iterates, too
            model: of the links: cc, prb; of serial robots pcc, lsk
            law: of chains: M0w, M0, M1
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and pose (or tip), legs (or sections), residual,
        iterations; of rods and chains energy, potential, and what `want` asks for.

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def inverse(
        self,
        pose: Pose | None = None,
        *,
        independent: Mapping[str, Any] | None = None,
        position: Numbers | None = None,
        direction: Numbers | None = None,
        bending: Numbers | None = None,
        curvature: Numbers | None = None,
        elbow: Numbers | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        want: Sequence[str] | None = None,
        with_respect_to: Sequence[str] | None = None,
        posture_threshold: Number | None = None,
        until: Mapping[str, Any] | None = None,
        all: bool | None = None,
        model: str | None = None,
        law: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Inputs from the pose.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform in the base frame: {x, y, phi}, or {position (3,), quaternion
                (4,) [w, x, y, z]}
            independent [m]: in place of `pose` where three legs hold the platform: {z, e1, e2}
            position [m]: of serial robots: the tip's place in the base frame, (3,)
            direction: of serial robots: the tip's axis in the base frame, (3,)
            bending: branch: +1 or -1 a leg, the sign of its curvature, (legs,)
            curvature [1/m]: branch: the solution nearest to these, (legs,)
            elbow: branch: +1 or -1 a leg, (legs,)
            start: where the search begins: a pose, inputs, or "last", the last answer to this thread
            wrench [N, N m]: of the world on the platform, about its reference point, in base axes: (fx, fy,
                m) or (6,)
            gravity [m/s^2]: in place of the robot's, in base axes, (3,)
            want: more to be answered: stiffness, stability, margins, sensitivity, shape, velocity, ...
            with_respect_to: paths of the robot's numbers by which `sensitivity` is taken, too
            posture_threshold [rad]: largest turn of a joint for which the linear model counts as valid
            until: {wrench, limit}: this load is added, up to `limit` times
            all: every solution: `solutions`
            model: of the links: cc, prb; of serial robots pcc, lsk
            law: of chains: M0w, M0, M1
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and inputs (or configuration and changes), legs, pose,
        residual.

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def velocity(
        self,
        pose: Pose | None = None,
        *,
        inputs: Numbers | None = None,
        independent: Mapping[str, Any] | None = None,
        configuration: Lists | None = None,
        changes: Lists | None = None,
        bending: Numbers | None = None,
        curvature: Numbers | None = None,
        elbow: Numbers | None = None,
        angles: Lists | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        twist: Numbers | None = None,
        rates: Numbers | None = None,
        along: Numbers | None = None,
        limit: Number | None = None,
        want: Sequence[str] | None = None,
        with_respect_to: Sequence[str] | None = None,
        model: str | None = None,
        law: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Velocity equations J (twist) = K (input rates), sensitivities, singularities.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform in the base frame: {x, y, phi}, or {position (3,), quaternion
                (4,) [w, x, y, z]}
            inputs [m, rad]: what the motors command, in the order of robot.inputs: (k,), or (n, k) for n
                rows
            independent [m]: in place of `pose` where three legs hold the platform: {z, e1, e2}
            configuration [rad, m]: of serial robots: the bend of each section, [theta, phi] or [beta_1,
                beta_2]
            changes [m]: of serial robots: length paid out, a list a section, a value a tendon
            bending: branch: +1 or -1 a leg, the sign of its curvature, (legs,)
            curvature [1/m]: branch: the solution nearest to these, (legs,)
            elbow: branch: +1 or -1 a leg, (legs,)
            angles [rad]: of pseudo-rigid chains: joints leg by leg
            start: where the search begins: a pose, inputs, or "last", the last answer to this thread
            wrench [N, N m]: of the world on the platform, about its reference point, in base axes: (fx, fy,
                m) or (6,)
            gravity [m/s^2]: in place of the robot's, in base axes, (3,)
            twist [m/s, rad/s]: of the platform's reference point, linear then angular, in base axes: (3,)
                or (6,)
            rates [m/s]: of the inputs, in place of `twist`, (k,)
            along: a direction, as a twist, along which the nearest type II singularity is sought
            limit: how far to look `along`; of a diagram the envelope's size [rad, m]
            want: more to be answered: stiffness, stability, margins, sensitivity, shape, velocity, ...
            with_respect_to: paths of the robot's numbers by which `sensitivity` is taken, too
            model: of the links: cc, prb; of serial robots pcc, lsk
            law: of chains: M0w, M0, M1
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and pose, J, K, U = J^-1 K, determinant, indices, type_1,
        type_2; with `twist` rates.

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def statics(
        self,
        pose: Pose | None = None,
        *,
        set_at: Pose | None = None,
        hold: str | None = None,
        tensions: Lists | None = None,
        lengths: Lists | None = None,
        inputs: Numbers | None = None,
        measured_tensions: Numbers | None = None,
        axial_forces: Numbers | None = None,
        deviation: Any | None = None,
        inverse: bool | None = None,
        bending: Numbers | None = None,
        curvature: Numbers | None = None,
        elbow: Numbers | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        want: Sequence[str] | None = None,
        with_respect_to: Sequence[str] | None = None,
        until: Mapping[str, Any] | None = None,
        posture_threshold: Number | None = None,
        model: str | None = None,
        law: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """A tendon-driven robot under a load, or the wrench on it sensed from forces.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform in the base frame: {x, y, phi}, or {position (3,), quaternion
                (4,) [w, x, y, z]}
            set_at [m, rad]: pose at which the tendons are set without load
            hold: what then stays of the inner tendon: tension or length
            tensions [N]: [T1, T2] a leg, in place of `set_at`
            lengths [m]: [l1 or None, l2 or None] a leg, in place of `set_at`
            inputs [m, rad]: what the motors command, in the order of robot.inputs: (k,), or (n, k) for n
                rows
            measured_tensions [N]: [T or None a leg]: what held tendons pull; the wrench is sensed
            axial_forces [N]: what each rod pulls at its guide, (6,); the wrench is sensed
            deviation [N]: standard deviation of the measured forces, one for all or one each
            inverse: with `pose`: it is held under the load, its tensions are answered
            bending: branch: +1 or -1 a leg, the sign of its curvature, (legs,)
            curvature [1/m]: branch: the solution nearest to these, (legs,)
            elbow: branch: +1 or -1 a leg, (legs,)
            start: where the search begins: a pose, inputs, or "last", the last answer to this thread
            wrench [N, N m]: of the world on the platform, about its reference point, in base axes: (fx, fy,
                m) or (6,)
            gravity [m/s^2]: in place of the robot's, in base axes, (3,)
            want: more to be answered: stiffness, stability, margins, sensitivity, shape, velocity, ...
            with_respect_to: paths of the robot's numbers by which `sensitivity` is taken, too
            until: {wrench, limit}: this load is added, up to `limit` times
            posture_threshold [rad]: largest turn of a joint for which the linear model counts as valid
            model: of the links: cc, prb; of serial robots pcc, lsk
            law: of chains: M0w, M0, M1
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and pose, legs with tensions and forces, wrench,
        stiffness, compliance, stable, potential, residual.

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def track(
        self,
        poses: Sequence[Pose] | None = None,
        *,
        from_: Pose | None = None,
        to: Mapping[str, Any] | None = None,
        samples: int | None = None,
        inputs: Numbers | None = None,
        pose: Pose | None = None,
        independent: Mapping[str, Any] | None = None,
        bending: Numbers | None = None,
        curvature: Numbers | None = None,
        elbow: Numbers | None = None,
        angles: Lists | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        objective: str | None = None,
        rk4_steps: int | None = None,
        set_at: Pose | None = None,
        tensions: Lists | None = None,
        lengths: Lists | None = None,
        range: Numbers | None = None,
        backward: bool | None = None,
        branches: bool | None = None,
        model: str | None = None,
        law: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Inputs along a path of poses; of rods and chains also a curve of equilibria.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            poses [m, rad]: path: the poses on the way
            from_ [m, rad]: path: the first pose
            to: path: the last pose; of a curve of equilibria what changes: {inputs or pose, wrench}
            samples: number of points, or of poses on the way
            inputs [m, rad]: what the motors command, in the order of robot.inputs: (k,), or (n, k) for n
                rows
            pose [m, rad]: of the platform in the base frame: {x, y, phi}, or {position (3,), quaternion
                (4,) [w, x, y, z]}
            independent [m]: in place of `pose` where three legs hold the platform: {z, e1, e2}
            bending: branch: +1 or -1 a leg, the sign of its curvature, (legs,)
            curvature [1/m]: branch: the solution nearest to these, (legs,)
            elbow: branch: +1 or -1 a leg, (legs,)
            angles [rad]: of pseudo-rigid chains: joints leg by leg
            start: where the search begins: a pose, inputs, or "last", the last answer to this thread
            wrench [N, N m]: of the world on the platform, about its reference point, in base axes: (fx, fy,
                m) or (6,)
            gravity [m/s^2]: in place of the robot's, in base axes, (3,)
            objective: what redundant legs do with their freedom: limits, singularity, smooth, none
            rk4_steps: of chains: Runge-Kutta steps between poses
            set_at [m, rad]: pose at which the tendons are set without load
            tensions [N]: [T1, T2] a leg, in place of `set_at`
            lengths [m]: [l1 or None, l2 or None] a leg, in place of `set_at`
            range: of a curve: [lowest, highest] of the parameter, (2,)
            backward: of a curve: set out with a falling parameter
            branches: of a curve: also the curves that leave its bifurcations
            model: of the links: cc, prb; of serial robots pcc, lsk
            law: of chains: M0w, M0, M1
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and rows, residual, reached; of a curve curves and
        equilibria.

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def diagram(
        self,
        section: int | None = None,
        *,
        changes: Lists | None = None,
        measured: Any | None = None,
        tolerance: Number | None = None,
        envelope: str | None = None,
        limit: Number | None = None,
        model: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """What the tendons of one section of a serial robot leave it free to do.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            section: of a serial robot, from 0
            changes [m]: of serial robots: length paid out, a list a section, a value a tendon
            measured [m]: of a diagram: changes that encoders read
            tolerance [m]: of a diagram: in place of the robot's
            envelope: of a diagram: square, disc or actuator
            limit: how far to look `along`; of a diagram the envelope's size [rad, m]
            model: of the links: cc, prb; of serial robots pcc, lsk
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and class_, word, amount, advice, point, slack, margin,
        over_tension, frontiers, polygon, boundary, area.

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def shape(
        self,
        pose: Pose | None = None,
        *,
        inputs: Numbers | None = None,
        independent: Mapping[str, Any] | None = None,
        configuration: Lists | None = None,
        changes: Lists | None = None,
        bending: Numbers | None = None,
        curvature: Numbers | None = None,
        elbow: Numbers | None = None,
        angles: Lists | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        samples: int | None = None,
        want: Sequence[str] | None = None,
        with_respect_to: Sequence[str] | None = None,
        model: str | None = None,
        law: str | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        set: Mapping[str, Any] | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Polylines for a picture.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform in the base frame: {x, y, phi}, or {position (3,), quaternion
                (4,) [w, x, y, z]}
            inputs [m, rad]: what the motors command, in the order of robot.inputs: (k,), or (n, k) for n
                rows
            independent [m]: in place of `pose` where three legs hold the platform: {z, e1, e2}
            configuration [rad, m]: of serial robots: the bend of each section, [theta, phi] or [beta_1,
                beta_2]
            changes [m]: of serial robots: length paid out, a list a section, a value a tendon
            bending: branch: +1 or -1 a leg, the sign of its curvature, (legs,)
            curvature [1/m]: branch: the solution nearest to these, (legs,)
            elbow: branch: +1 or -1 a leg, (legs,)
            angles [rad]: of pseudo-rigid chains: joints leg by leg
            start: where the search begins: a pose, inputs, or "last", the last answer to this thread
            wrench [N, N m]: of the world on the platform, about its reference point, in base axes: (fx, fy,
                m) or (6,)
            gravity [m/s^2]: in place of the robot's, in base axes, (3,)
            samples: number of points, or of poses on the way
            want: more to be answered: stiffness, stability, margins, sensitivity, shape, velocity, ...
            with_respect_to: paths of the robot's numbers by which `sensitivity` is taken, too
            model: of the links: cc, prb; of serial robots pcc, lsk
            law: of chains: M0w, M0, M1
            theta_is: what an input theta is the angle of: tangent, chord
            max_iterations: the solve's bound
            tilt: poses in space have tilt, azimuth and torsion, too
            set: {path in the robot file: value}: changes the robot for this question alone

        The answer has `ok`, `status`, `message`, and pose, backbones, tendons, lines, platform, base,
        frames; points in the base frame [m].

        With arrays of one dimension more than one value needs:
            threads: of n rows, default all cores; the bytes do not depend on it
            out: arrays of your own that become the answer's, by name
            outputs, path: as of Robot.prepare
            Of n rows the answer is `Columns`: arrays (n, ...), and statuses a row.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def describe(
        self,
        set: Mapping[str, Any] | None = None,
        *,
        tilt: bool | None = None,
        max_iterations: int | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        model: str | None = None,
    ) -> Answer:
        """What the robot has.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            set: {path in the robot file: value}: changes the robot for this question alone
            tilt: poses in space have tilt, azimuth and torsion, too
            max_iterations: the solve's bound
            theta_is: what an input theta is the angle of: tangent, chord
            law: of chains: M0w, M0, M1
            model: of the links: cc, prb; of serial robots pcc, lsk

        The answer has `ok`, `status`, `message`, and kind, space, inputs, pose, home, legs or sections,
        models, versions.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """
