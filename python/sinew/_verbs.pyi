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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        until: Mapping[str, Any] | None = None,
        posture_threshold: Number | None = None,
        want: Sequence[str] | None = None,
        all: bool | None = None,
        trace: bool | None = None,
        twist: Numbers | None = None,
        rates: Numbers | None = None,
        along: Numbers | None = None,
        limit: Number | None = None,
        samples: int | None = None,
        configuration: Lists | None = None,
        changes: Lists | None = None,
        slack: Numbers | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Pose of the platform or tip from the inputs.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            inputs [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of a rod its
                length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for n rows
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            start: where the search begins: a pose, of inverse and track inputs, of a serial robot its
                configuration, or last, where the last question with a start ended; default the robot's home
            wrench [N, N m]: force and moment on the platform, about its reference point, in base axes; (3,)
                in the plane, (6,) in space
            gravity [m/s^2]: of rods and platforms that have a mass [m/s2]; default the file's; (3,)
            until [N]: a wrench that is added again and again until the robot buckles, up to `limit` times
            posture_threshold [rad]: turn of a joint up to which the linear model counts as valid
            want: what is answered about the configuration: velocity, shape, stiffness, stability, margins,
                sensitivity, lines, as far as the robot has them; pose and legs are added unless one of them
                is named
            all: every solution, not only the one wanted
            trace: the residual of each iterate is answered, too
            twist [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space three each,
                of rods with three inputs z, x and y of them alone, too; answers the rates of the inputs;
                with the want velocity; (3,) in the plane, (6,) in space
            rates [m/s]: of the inputs, in place of `twist`; answers the twist of the platform; (k,), or (n,
                k) for n rows
            along [m/s, rad/s]: a direction in which the nearest type II is looked for; with the want
                velocity; (3,) in the plane, (6,) in space
            limit: how far to look `along` its direction; of a diagram the envelope's size
            samples: points of each backbone of a shape; poses on a path, default 60; points on a curve, at
                most, default 500
            configuration [rad, m]: of a serial robot two angles a section: theta, phi of a neutral
                backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its extension;
                sections not given are straight
            changes [m]: of a serial robot the change of each tendon, > 0 pays out, section after section
            slack [m]: what the tendons of each section are paid out beyond its configuration; < 0 stiffens

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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        independent: Mapping[str, Any] | None = None,
        bending: Numbers | None = None,
        elbow: Numbers | None = None,
        curvature: Numbers | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        want: Sequence[str] | None = None,
        all: bool | None = None,
        twist: Numbers | None = None,
        rates: Numbers | None = None,
        along: Numbers | None = None,
        limit: Number | None = None,
        samples: int | None = None,
        position: Numbers | None = None,
        direction: Numbers | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Inputs from the pose.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform, of a serial robot of its tip; in the plane x, y, phi, in space
                x, y, z and a quaternion, on the command line also a rotation vector
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            independent [m]: in place of `pose` where hinges hold the platform in planes, or three rods hold
                it: height and two components of its quaternion; of hinges a mode, too, tilt or half_turn
            bending: sign of each leg's curvature; (legs,)
            elbow: side to which the strut of each leg turns, where the leg has a motor or a rail; (legs,)
            curvature [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            start: where the search begins: a pose, of inverse and track inputs, of a serial robot its
                configuration, or last, where the last question with a start ended; default the robot's home
            wrench [N, N m]: force and moment on the platform, about its reference point, in base axes; (3,)
                in the plane, (6,) in space
            gravity [m/s^2]: of rods and platforms that have a mass [m/s2]; default the file's; (3,)
            want: what is answered about the configuration: velocity, shape, stiffness, stability, margins,
                sensitivity, lines, as far as the robot has them; pose and legs are added unless one of them
                is named
            all: every solution, not only the one wanted
            twist [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space three each,
                of rods with three inputs z, x and y of them alone, too; answers the rates of the inputs;
                with the want velocity; (3,) in the plane, (6,) in space
            rates [m/s]: of the inputs, in place of `twist`; answers the twist of the platform; (k,), or (n,
                k) for n rows
            along [m/s, rad/s]: a direction in which the nearest type II is looked for; with the want
                velocity; (3,) in the plane, (6,) in space
            limit: how far to look `along` its direction; of a diagram the envelope's size
            samples: points of each backbone of a shape; poses on a path, default 60; points on a curve, at
                most, default 500
            position [m]: of a serial robot's tip; (3,)
            direction: in which a serial robot's tip points; (3,)

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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        inputs: Numbers | None = None,
        independent: Mapping[str, Any] | None = None,
        bending: Numbers | None = None,
        elbow: Numbers | None = None,
        curvature: Numbers | None = None,
        angles: Lists | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        want: Sequence[str] | None = None,
        twist: Numbers | None = None,
        rates: Numbers | None = None,
        along: Numbers | None = None,
        limit: Number | None = None,
        samples: int | None = None,
        configuration: Lists | None = None,
        changes: Lists | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Velocity equations J (twist) = K (input rates), sensitivities, singularities.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform, of a serial robot of its tip; in the plane x, y, phi, in space
                x, y, z and a quaternion, on the command line also a rotation vector
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of a rod its
                length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for n rows
            independent [m]: in place of `pose` where hinges hold the platform in planes, or three rods hold
                it: height and two components of its quaternion; of hinges a mode, too, tilt or half_turn
            bending: sign of each leg's curvature; (legs,)
            elbow: side to which the strut of each leg turns, where the leg has a motor or a rail; (legs,)
            curvature [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            angles [rad]: of the joints of each chain, from the first sprung one; before them the direction
                of a first link that a motor turns
            start: where the search begins: a pose, of inverse and track inputs, of a serial robot its
                configuration, or last, where the last question with a start ended; default the robot's home
            wrench [N, N m]: force and moment on the platform, about its reference point, in base axes; (3,)
                in the plane, (6,) in space
            gravity [m/s^2]: of rods and platforms that have a mass [m/s2]; default the file's; (3,)
            want: what is answered about the configuration: velocity, shape, stiffness, stability, margins,
                sensitivity, lines, as far as the robot has them; pose and legs are added unless one of them
                is named
            twist [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space three each,
                of rods with three inputs z, x and y of them alone, too; answers the rates of the inputs;
                with the want velocity; (3,) in the plane, (6,) in space
            rates [m/s]: of the inputs, in place of `twist`; answers the twist of the platform; (k,), or (n,
                k) for n rows
            along [m/s, rad/s]: a direction in which the nearest type II is looked for; with the want
                velocity; (3,) in the plane, (6,) in space
            limit: how far to look `along` its direction; of a diagram the envelope's size
            samples: points of each backbone of a shape; poses on a path, default 60; points on a curve, at
                most, default 500
            configuration [rad, m]: of a serial robot two angles a section: theta, phi of a neutral
                backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its extension;
                sections not given are straight
            changes [m]: of a serial robot the change of each tendon, > 0 pays out, section after section

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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        inputs: Numbers | None = None,
        bending: Numbers | None = None,
        elbow: Numbers | None = None,
        curvature: Numbers | None = None,
        start: Any | None = None,
        set_at: Pose | None = None,
        hold: str | None = None,
        tensions: Lists | None = None,
        lengths: Lists | None = None,
        inverse: bool | None = None,
        axial_forces: Numbers | None = None,
        measured_tensions: Numbers | None = None,
        deviation: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        until: Mapping[str, Any] | None = None,
        posture_threshold: Number | None = None,
        want: Sequence[str] | None = None,
        twist: Numbers | None = None,
        rates: Numbers | None = None,
        samples: int | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """A tendon-driven robot under a load, or the wrench on it sensed from forces.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform, of a serial robot of its tip; in the plane x, y, phi, in space
                x, y, z and a quaternion, on the command line also a rotation vector
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of a rod its
                length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for n rows
            bending: sign of each leg's curvature; (legs,)
            elbow: side to which the strut of each leg turns, where the leg has a motor or a rail; (legs,)
            curvature [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            start: where the search begins: a pose, of inverse and track inputs, of a serial robot its
                configuration, or last, where the last question with a start ended; default the robot's home
            set_at [m, rad]: the pose at which the tendons are set without load, the outer ones loose
            hold: what stays after `set_at` or with `pose`: tension (default) or length
            tensions [N]: of both tendons of each leg; (legs, 2)
            lengths [m]: of the tendon of each leg whose length is held; null, on the command line -, leaves
                the other one loose; (legs, 2)
            inverse: `pose` is held under the load, and the tensions for it answered
            axial_forces [N]: what each of six rods pulls at its guide; answers the wrench on the platform
            measured_tensions [N]: what the tendons at `lengths` pull, a leg each; answers the wrench on the
                platform; (legs,)
            deviation [N]: standard deviation of what is measured, one for all or one each; answers how well
                the wrench is known
            wrench [N, N m]: force and moment on the platform, about its reference point, in base axes; (3,)
                in the plane, (6,) in space
            gravity [m/s^2]: of rods and platforms that have a mass [m/s2]; default the file's; (3,)
            until [N]: a wrench that is added again and again until the robot buckles, up to `limit` times
            posture_threshold [rad]: turn of a joint up to which the linear model counts as valid
            want: what is answered about the configuration: velocity, shape, stiffness, stability, margins,
                sensitivity, lines, as far as the robot has them; pose and legs are added unless one of them
                is named
            twist [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space three each,
                of rods with three inputs z, x and y of them alone, too; answers the rates of the inputs;
                with the want velocity; (3,) in the plane, (6,) in space
            rates [m/s]: of the inputs, in place of `twist`; answers the twist of the platform; (k,), or (n,
                k) for n rows
            samples: points of each backbone of a shape; poses on a path, default 60; points on a curve, at
                most, default 500

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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        inputs: Numbers | None = None,
        pose: Pose | None = None,
        independent: Mapping[str, Any] | None = None,
        bending: Numbers | None = None,
        elbow: Numbers | None = None,
        curvature: Numbers | None = None,
        angles: Lists | None = None,
        start: Any | None = None,
        set_at: Pose | None = None,
        hold: str | None = None,
        tensions: Lists | None = None,
        lengths: Lists | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        samples: int | None = None,
        from_: Any | None = None,
        to: Mapping[str, Any] | None = None,
        objective: str | None = None,
        rk4_steps: int | None = None,
        range: Numbers | None = None,
        backward: bool | None = None,
        branches: bool | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Inputs along a path of poses; of rods and chains also a curve of equilibria.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            poses [m, rad]: the path, pose by pose
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of a rod its
                length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for n rows
            pose [m, rad]: of the platform, of a serial robot of its tip; in the plane x, y, phi, in space
                x, y, z and a quaternion, on the command line also a rotation vector
            independent [m]: in place of `pose` where hinges hold the platform in planes, or three rods hold
                it: height and two components of its quaternion; of hinges a mode, too, tilt or half_turn
            bending: sign of each leg's curvature; (legs,)
            elbow: side to which the strut of each leg turns, where the leg has a motor or a rail; (legs,)
            curvature [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            angles [rad]: of the joints of each chain, from the first sprung one; before them the direction
                of a first link that a motor turns
            start: where the search begins: a pose, of inverse and track inputs, of a serial robot its
                configuration, or last, where the last question with a start ended; default the robot's home
            set_at [m, rad]: the pose at which the tendons are set without load, the outer ones loose
            hold: what stays after `set_at` or with `pose`: tension (default) or length
            tensions [N]: of both tendons of each leg; (legs, 2)
            lengths [m]: of the tendon of each leg whose length is held; null, on the command line -, leaves
                the other one loose; (legs, 2)
            wrench [N, N m]: force and moment on the platform, about its reference point, in base axes; (3,)
                in the plane, (6,) in space
            gravity [m/s^2]: of rods and platforms that have a mass [m/s2]; default the file's; (3,)
            samples: points of each backbone of a shape; poses on a path, default 60; points on a curve, at
                most, default 500
            from_ [m, rad]: first pose of a path, of rods with three inputs z, e1 and e2
            to: last pose of a path; of a curve of equilibria what changes along it: inputs, tensions,
                lengths, wrench, pose
            objective: what redundant legs do with their freedom: limits, singularity, smooth or none
            rk4_steps: Runge-Kutta steps between poses; default the flow itself
            range: how far a curve goes: 0 is its beginning, 1 what it leads to; default [0, 1]; (2,)
            backward: a curve sets out the other way
            branches: curves that leave it at bifurcations are followed, too

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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        limit: Number | None = None,
        changes: Lists | None = None,
        measured: Any | None = None,
        tolerance: Number | None = None,
        envelope: str | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """What the tendons of one section of a serial robot leave it free to do.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            section: which section, from 0
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            limit: how far to look `along` its direction; of a diagram the envelope's size
            changes [m]: of a serial robot the change of each tendon, > 0 pays out, section after section
            measured [m]: changes that encoders read, beside those commanded
            tolerance [m]: of a tendon before it counts as slack or too short; default the file's
            envelope: bends that a section is allowed: square, disc or actuator; default its limit

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
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        inputs: Numbers | None = None,
        independent: Mapping[str, Any] | None = None,
        bending: Numbers | None = None,
        elbow: Numbers | None = None,
        curvature: Numbers | None = None,
        angles: Lists | None = None,
        start: Any | None = None,
        wrench: Numbers | None = None,
        gravity: Numbers | None = None,
        want: Sequence[str] | None = None,
        twist: Numbers | None = None,
        rates: Numbers | None = None,
        along: Numbers | None = None,
        limit: Number | None = None,
        samples: int | None = None,
        configuration: Lists | None = None,
        changes: Lists | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Polylines for a picture.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose [m, rad]: of the platform, of a serial robot of its tip; in the plane x, y, phi, in space
                x, y, z and a quaternion, on the command line also a rotation vector
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of a rod its
                length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for n rows
            independent [m]: in place of `pose` where hinges hold the platform in planes, or three rods hold
                it: height and two components of its quaternion; of hinges a mode, too, tilt or half_turn
            bending: sign of each leg's curvature; (legs,)
            elbow: side to which the strut of each leg turns, where the leg has a motor or a rail; (legs,)
            curvature [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            angles [rad]: of the joints of each chain, from the first sprung one; before them the direction
                of a first link that a motor turns
            start: where the search begins: a pose, of inverse and track inputs, of a serial robot its
                configuration, or last, where the last question with a start ended; default the robot's home
            wrench [N, N m]: force and moment on the platform, about its reference point, in base axes; (3,)
                in the plane, (6,) in space
            gravity [m/s^2]: of rods and platforms that have a mass [m/s2]; default the file's; (3,)
            want: what is answered about the configuration: velocity, shape, stiffness, stability, margins,
                sensitivity, lines, as far as the robot has them; pose and legs are added unless one of them
                is named
            twist [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space three each,
                of rods with three inputs z, x and y of them alone, too; answers the rates of the inputs;
                with the want velocity; (3,) in the plane, (6,) in space
            rates [m/s]: of the inputs, in place of `twist`; answers the twist of the platform; (k,), or (n,
                k) for n rows
            along [m/s, rad/s]: a direction in which the nearest type II is looked for; with the want
                velocity; (3,) in the plane, (6,) in space
            limit: how far to look `along` its direction; of a diagram the envelope's size
            samples: points of each backbone of a shape; poses on a path, default 60; points on a curve, at
                most, default 500
            configuration [rad, m]: of a serial robot two angles a section: theta, phi of a neutral
                backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its extension;
                sections not given are straight
            changes [m]: of a serial robot the change of each tendon, > 0 pays out, section after section

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
        model: str | None = None,
        theta_is: str | None = None,
        law: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
    ) -> Answer:
        """What the robot has.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            set: changes the robot for this question alone: values by their paths in its file, such as
                legs[0].link.length; on the command line it may be repeated
            model: how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of tendon-
                driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc (exact) or
                lsk (linearised)
            theta_is: what an input theta is the angle of: tangent (default) or chord
            law: how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's), M1
                (tendons straight between discs)
            max_iterations: most iterations of the solver; default 100, of rods 4000, of rods that bear
                torque 400
            tilt: poses of the answer have tilt, azimuth and torsion, too; in space only

        The answer has `ok`, `status`, `message`, and kind, space, inputs, pose, home, legs or sections,
        models, versions.

        Raises InputError where a field is not to be read. No solution is no error: see `status`, `message`.
        """
