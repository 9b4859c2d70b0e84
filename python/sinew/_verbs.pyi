"""Written by tools/python_stubs.py of _fields.py."""
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ._types import Lists, Number, Numbers, Pose, Rows
from .answer import Answer, Record
from .identification import Identification

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
        tensions: Lists | None = None,
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
        following: Numbers | None = None,
        distributed: Numbers | None = None,
        distributed_following: Numbers | None = None,
        loads: Any | None = None,
        balance: str | None = None,
        order: int | None = None,
        elements: int | None = None,
        accuracy: Number | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Pose of the platform or tip from the inputs.

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            inputs (numbers) [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of
                a rod its length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for
                n rows
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            start (number, list, dict or str): where the search begins: a pose, of inverse and track inputs,
                of a serial robot its configuration, of an arm the mean curvatures and torsion of equal
                parts, as `all` tells them of each solution, of a platform on legs of sections a solution's
                pose and curvatures, or last, where the last question with a start ended, of `track` of an
                arm where its last path did, with what friction remembers; default the robot's home
            tensions (lists of numbers) [N]: of both tendons of each leg; of an arm those of each section,
                of legs of sections those of leg 0 first, null for a tendon that `changes` has; a list each,
                or an array
            wrench (numbers) [N, N m]: force and moment on the platform, about its reference point, of an
                arm on its tip, in base axes; (3,) in the plane, (6,) in space
            gravity (numbers) [m/s^2]: of rods, arms and platforms that have a mass [m/s2]; default the
                file's; (3,)
            until (dict) [N]: a wrench that is added again and again until the robot buckles, up to `limit`
                times
            posture_threshold (number) [rad]: turn of a joint up to which the linear model counts as valid
            want (list of str): what is answered about the configuration: velocity, shape, stiffness,
                stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are
                added unless one of them is named
            all (bool): every solution, not only the one wanted
            trace (bool): the residual of each iterate is answered, too
            twist (numbers) [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space
                three each, of rods with three inputs z, x and y of them alone, too; answers the rates of
                the inputs; with the want velocity; (3,) in the plane, (6,) in space
            rates (numbers) [m/s]: of the inputs, in place of `twist`; answers the twist of the platform;
                (k,), or (n, k) for n rows
            along (numbers) [m/s, rad/s]: a direction in which the nearest type II is looked for; with the
                want velocity; (3,) in the plane, (6,) in space
            limit (number): how far to look `along` its direction; of a diagram the envelope's size
            samples (int): points of each backbone of a shape; poses on a path, default 60; points on a
                curve, at most, default 500
            configuration (lists of numbers) [rad, m]: of a serial robot two angles a section: theta, phi of
                a neutral backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its
                extension; sections not given are straight; a list each, or an array
            changes (lists of numbers) [m]: of a serial robot or an arm the change of each tendon, > 0 pays
                out, section after section, of legs of sections leg after leg; a list each, or an array
            slack (numbers) [m]: what the tendons of each section are paid out beyond its configuration; < 0
                stiffens; (k,)
            following (numbers) [N, N m]: force and moment on an arm's tip, or on the platform on legs of
                sections, in its own axes, with which they turn; (3,) in the plane, (6,) in space
            distributed (numbers) [N/m]: force on all of an arm's backbone, or on those of all legs of
                sections, in base axes [N/m]; (3,)
            distributed_following (numbers) [N/m]: the same in the backbone's own axes [N/m]; in the plane x
                to its right and y along it; (3,)
            loads (number, list, dict or str): on an arm's backbone: a list of place, from the base along
                it, wrench and, where it turns with the place, following; on legs of sections with the leg,
                from 0
            balance (str): how an arm's equilibrium is written: energy (default), or as published models
                have it: projected, collocated, closed_form; a path knows energy alone
            order (int): of the polynomials of an arm's strain, 0 to 9, without refinement; default as
                `accuracy` needs (docs/arm-models.md)
            elements (int): of each section (rod) or between two discs (subsegment_rod), without refinement;
                joints between two discs (prb); default as `order` or `accuracy` needs
            accuracy (number): of an arm's tip to which polynomials are refined, over its length, above 0
                and up to 1; default 1e-6. Without refinement give elements

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            pose: of the platform; in the plane x, y [m] and phi [rad], in space position (3,) [m] and
                quaternion (4,), w first
            tip: of a serial robot instead of pose and legs: position (3,) [m] and quaternion (4,), w first
            legs: list of one record a leg: curvature [1/m], chord [m], tendon_lengths (2,) [m]; of a rod
                length [m], force and force_0 (3,) [N], moment and moment_0 (3,) [N m]
            sections: of a serial robot, list of one record a section: position (3,) [m] and quaternion (4,)
                of its end
            configuration: of a serial robot, (sections, 2) [rad], where lengths vary (sections, 3) [rad, m]
            changes: of a serial robot's tendons, (sections, tendons) [m], or a list each where sections
                differ
            residual: number [m], of rods and chains without a unit: the largest error of what was solved
            iterations: int, of the solver
            energy, potential: of rods and chains, numbers [J]
            J, K, stiffness, stable, sensitivity, margins, backbones: what `want` asks for, and more; see
                `velocity`, `statics`, `shape`

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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
        following: Numbers | None = None,
        distributed: Numbers | None = None,
        distributed_following: Numbers | None = None,
        loads: Any | None = None,
        balance: str | None = None,
        order: int | None = None,
        elements: int | None = None,
        accuracy: Number | None = None,
        tension_limit: Number | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Inputs from the pose.

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose (pose) [m, rad]: of the platform, of a serial robot of its tip; of statics of legs of
                sections where it is held, or with `measured_tensions` was seen; in the plane x, y, phi, in
                space x, y, z and a quaternion, on the command line also a rotation vector
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            independent (dict) [m]: in place of `pose` where hinges hold the platform in planes, or three
                rods hold it: height and two components of its quaternion; of hinges a mode, too, tilt or
                half_turn
            bending (numbers): sign of each leg's curvature; (legs,)
            elbow (numbers): side to which the strut of each leg turns, where the leg has a motor or a rail;
                (legs,)
            curvature (numbers) [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            start (number, list, dict or str): where the search begins: a pose, of inverse and track inputs,
                of a serial robot its configuration, of an arm the mean curvatures and torsion of equal
                parts, as `all` tells them of each solution, of a platform on legs of sections a solution's
                pose and curvatures, or last, where the last question with a start ended, of `track` of an
                arm where its last path did, with what friction remembers; default the robot's home
            wrench (numbers) [N, N m]: force and moment on the platform, about its reference point, of an
                arm on its tip, in base axes; (3,) in the plane, (6,) in space
            gravity (numbers) [m/s^2]: of rods, arms and platforms that have a mass [m/s2]; default the
                file's; (3,)
            want (list of str): what is answered about the configuration: velocity, shape, stiffness,
                stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are
                added unless one of them is named
            all (bool): every solution, not only the one wanted
            twist (numbers) [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space
                three each, of rods with three inputs z, x and y of them alone, too; answers the rates of
                the inputs; with the want velocity; (3,) in the plane, (6,) in space
            rates (numbers) [m/s]: of the inputs, in place of `twist`; answers the twist of the platform;
                (k,), or (n, k) for n rows
            along (numbers) [m/s, rad/s]: a direction in which the nearest type II is looked for; with the
                want velocity; (3,) in the plane, (6,) in space
            limit (number): how far to look `along` its direction; of a diagram the envelope's size
            samples (int): points of each backbone of a shape; poses on a path, default 60; points on a
                curve, at most, default 500
            position (numbers) [m]: of the tip of a serial robot or an arm, or of the platform on legs of
                sections; of statics where it was seen; (3,)
            direction (numbers): in which the tip of a serial robot or an arm points, or the z axis of the
                platform on legs of sections; (3,)
            following (numbers) [N, N m]: force and moment on an arm's tip, or on the platform on legs of
                sections, in its own axes, with which they turn; (3,) in the plane, (6,) in space
            distributed (numbers) [N/m]: force on all of an arm's backbone, or on those of all legs of
                sections, in base axes [N/m]; (3,)
            distributed_following (numbers) [N/m]: the same in the backbone's own axes [N/m]; in the plane x
                to its right and y along it; (3,)
            loads (number, list, dict or str): on an arm's backbone: a list of place, from the base along
                it, wrench and, where it turns with the place, following; on legs of sections with the leg,
                from 0
            balance (str): how an arm's equilibrium is written: energy (default), or as published models
                have it: projected, collocated, closed_form; a path knows energy alone
            order (int): of the polynomials of an arm's strain, 0 to 9, without refinement; default as
                `accuracy` needs (docs/arm-models.md)
            elements (int): of each section (rod) or between two discs (subsegment_rod), without refinement;
                joints between two discs (prb); default as `order` or `accuracy` needs
            accuracy (number): of an arm's tip to which polynomials are refined, over its length, above 0
                and up to 1; default 1e-6. Without refinement give elements
            tension_limit (number) [N]: most that a tendon may pull

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            inputs: (k,) [m, rad], in leg order
            pose: of the platform; in the plane x, y [m] and phi [rad], in space position (3,) [m] and
                quaternion (4,), w first
            legs: list of one record a leg: curvature [1/m], chord [m], tendon_lengths (2,) [m]; of a rod
                length [m], force and force_0 (3,) [N], moment and moment_0 (3,) [N m]
            tip: of a serial robot instead of pose and legs: position (3,) [m] and quaternion (4,), w first
            configuration: of a serial robot, (sections, 2) [rad], where lengths vary (sections, 3) [rad, m]
            changes: of a serial robot's tendons, (sections, tendons) [m], or a list each where sections
                differ
            residual: number [m], of rods and chains without a unit: the largest error of what was solved
            J, K, stiffness, stable, sensitivity, margins, backbones: what `want` asks for, and more; see
                `velocity`, `statics`, `shape`

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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
        tensions: Lists | None = None,
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
        following: Numbers | None = None,
        distributed: Numbers | None = None,
        distributed_following: Numbers | None = None,
        loads: Any | None = None,
        balance: str | None = None,
        order: int | None = None,
        elements: int | None = None,
        accuracy: Number | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Velocity equations J (twist) = K (input rates), sensitivities, singularities.

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose (pose) [m, rad]: of the platform, of a serial robot of its tip; of statics of legs of
                sections where it is held, or with `measured_tensions` was seen; in the plane x, y, phi, in
                space x, y, z and a quaternion, on the command line also a rotation vector
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs (numbers) [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of
                a rod its length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for
                n rows
            independent (dict) [m]: in place of `pose` where hinges hold the platform in planes, or three
                rods hold it: height and two components of its quaternion; of hinges a mode, too, tilt or
                half_turn
            bending (numbers): sign of each leg's curvature; (legs,)
            elbow (numbers): side to which the strut of each leg turns, where the leg has a motor or a rail;
                (legs,)
            curvature (numbers) [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            angles (lists of numbers) [rad]: of the joints of each chain, from the first sprung one; before
                them the direction of a first link that a motor turns; a list each, or an array
            start (number, list, dict or str): where the search begins: a pose, of inverse and track inputs,
                of a serial robot its configuration, of an arm the mean curvatures and torsion of equal
                parts, as `all` tells them of each solution, of a platform on legs of sections a solution's
                pose and curvatures, or last, where the last question with a start ended, of `track` of an
                arm where its last path did, with what friction remembers; default the robot's home
            tensions (lists of numbers) [N]: of both tendons of each leg; of an arm those of each section,
                of legs of sections those of leg 0 first, null for a tendon that `changes` has; a list each,
                or an array
            wrench (numbers) [N, N m]: force and moment on the platform, about its reference point, of an
                arm on its tip, in base axes; (3,) in the plane, (6,) in space
            gravity (numbers) [m/s^2]: of rods, arms and platforms that have a mass [m/s2]; default the
                file's; (3,)
            want (list of str): what is answered about the configuration: velocity, shape, stiffness,
                stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are
                added unless one of them is named
            twist (numbers) [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space
                three each, of rods with three inputs z, x and y of them alone, too; answers the rates of
                the inputs; with the want velocity; (3,) in the plane, (6,) in space
            rates (numbers) [m/s]: of the inputs, in place of `twist`; answers the twist of the platform;
                (k,), or (n, k) for n rows
            along (numbers) [m/s, rad/s]: a direction in which the nearest type II is looked for; with the
                want velocity; (3,) in the plane, (6,) in space
            limit (number): how far to look `along` its direction; of a diagram the envelope's size
            samples (int): points of each backbone of a shape; poses on a path, default 60; points on a
                curve, at most, default 500
            configuration (lists of numbers) [rad, m]: of a serial robot two angles a section: theta, phi of
                a neutral backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its
                extension; sections not given are straight; a list each, or an array
            changes (lists of numbers) [m]: of a serial robot or an arm the change of each tendon, > 0 pays
                out, section after section, of legs of sections leg after leg; a list each, or an array
            following (numbers) [N, N m]: force and moment on an arm's tip, or on the platform on legs of
                sections, in its own axes, with which they turn; (3,) in the plane, (6,) in space
            distributed (numbers) [N/m]: force on all of an arm's backbone, or on those of all legs of
                sections, in base axes [N/m]; (3,)
            distributed_following (numbers) [N/m]: the same in the backbone's own axes [N/m]; in the plane x
                to its right and y along it; (3,)
            loads (number, list, dict or str): on an arm's backbone: a list of place, from the base along
                it, wrench and, where it turns with the place, following; on legs of sections with the leg,
                from 0
            balance (str): how an arm's equilibrium is written: energy (default), or as published models
                have it: projected, collocated, closed_form; a path knows energy alone
            order (int): of the polynomials of an arm's strain, 0 to 9, without refinement; default as
                `accuracy` needs (docs/arm-models.md)
            elements (int): of each section (rod) or between two discs (subsegment_rod), without refinement;
                joints between two discs (prb); default as `order` or `accuracy` needs
            accuracy (number): of an arm's tip to which polynomials are refined, over its length, above 0
                and up to 1; default 1e-6. Without refinement give elements

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            pose: of the platform; in the plane x, y [m] and phi [rad], in space position (3,) [m] and
                quaternion (4,), w first
            tip: of a serial robot instead of pose and legs: position (3,) [m] and quaternion (4,), w first
            J, K: (m, m) and (m, k), J (twist) = K (rates), SI; m is 3 in the plane, 6 in space, k the
                number of inputs; of a serial robot of c configuration variables (6, c) and (tendons, c):
                twist of the tip and rates of the tendons by their rates
            U: (m, k), J^-1 K: sensitivities of the pose to the inputs
            determinant: number, of J where it is square
            indices: record of numbers: condition, condition_homogenised; position and rotation, the largest
                singular values of those rows of U
            type_1, type_2: singularities: list of legs; record with singular, class_, rank
            rates: with `twist`, (k,) [m/s, rad/s]
            twist: with `rates`, (3,) or (6,) [m/s, rad/s]
            residual: number [m], of rods and chains without a unit: the largest error of what was solved

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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
        changes: Lists | None = None,
        position: Numbers | None = None,
        following: Numbers | None = None,
        distributed: Numbers | None = None,
        distributed_following: Numbers | None = None,
        loads: Any | None = None,
        balance: str | None = None,
        order: int | None = None,
        elements: int | None = None,
        accuracy: Number | None = None,
        force_alone: bool | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """A tendon-driven robot under a load, or the wrench on it sensed from forces.

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose (pose) [m, rad]: of the platform, of a serial robot of its tip; of statics of legs of
                sections where it is held, or with `measured_tensions` was seen; in the plane x, y, phi, in
                space x, y, z and a quaternion, on the command line also a rotation vector
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs (numbers) [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of
                a rod its length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for
                n rows
            bending (numbers): sign of each leg's curvature; (legs,)
            elbow (numbers): side to which the strut of each leg turns, where the leg has a motor or a rail;
                (legs,)
            curvature (numbers) [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            start (number, list, dict or str): where the search begins: a pose, of inverse and track inputs,
                of a serial robot its configuration, of an arm the mean curvatures and torsion of equal
                parts, as `all` tells them of each solution, of a platform on legs of sections a solution's
                pose and curvatures, or last, where the last question with a start ended, of `track` of an
                arm where its last path did, with what friction remembers; default the robot's home
            set_at (pose) [m, rad]: the pose at which the tendons are set without load, the outer ones loose
            hold (str): what stays after `set_at` or with `pose`: tension (default) or length
            tensions (lists of numbers) [N]: of both tendons of each leg; of an arm those of each section,
                of legs of sections those of leg 0 first, null for a tendon that `changes` has; a list each,
                or an array
            lengths (lists of numbers) [m]: of the tendon of each leg whose length is held; null, on the
                command line -, leaves the other one loose; (legs, 2)
            inverse (bool): `pose` is held under the load, and the tensions for it answered
            axial_forces (numbers) [N]: what each of six rods pulls at its guide; answers the wrench on the
                platform; (k,)
            measured_tensions (numbers) [N]: what the tendons at `lengths` pull, a leg each, of an arm those
                at `changes`, one each; answers the wrench on the platform; (legs,)
            deviation (number, list, dict or str) [N]: standard deviation of what is measured, one for all
                or one each; answers how well the wrench is known
            wrench (numbers) [N, N m]: force and moment on the platform, about its reference point, of an
                arm on its tip, in base axes; (3,) in the plane, (6,) in space
            gravity (numbers) [m/s^2]: of rods, arms and platforms that have a mass [m/s2]; default the
                file's; (3,)
            until (dict) [N]: a wrench that is added again and again until the robot buckles, up to `limit`
                times
            posture_threshold (number) [rad]: turn of a joint up to which the linear model counts as valid
            want (list of str): what is answered about the configuration: velocity, shape, stiffness,
                stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are
                added unless one of them is named
            twist (numbers) [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space
                three each, of rods with three inputs z, x and y of them alone, too; answers the rates of
                the inputs; with the want velocity; (3,) in the plane, (6,) in space
            rates (numbers) [m/s]: of the inputs, in place of `twist`; answers the twist of the platform;
                (k,), or (n, k) for n rows
            samples (int): points of each backbone of a shape; poses on a path, default 60; points on a
                curve, at most, default 500
            changes (lists of numbers) [m]: of a serial robot or an arm the change of each tendon, > 0 pays
                out, section after section, of legs of sections leg after leg; a list each, or an array
            position (numbers) [m]: of the tip of a serial robot or an arm, or of the platform on legs of
                sections; of statics where it was seen; (3,)
            following (numbers) [N, N m]: force and moment on an arm's tip, or on the platform on legs of
                sections, in its own axes, with which they turn; (3,) in the plane, (6,) in space
            distributed (numbers) [N/m]: force on all of an arm's backbone, or on those of all legs of
                sections, in base axes [N/m]; (3,)
            distributed_following (numbers) [N/m]: the same in the backbone's own axes [N/m]; in the plane x
                to its right and y along it; (3,)
            loads (number, list, dict or str): on an arm's backbone: a list of place, from the base along
                it, wrench and, where it turns with the place, following; on legs of sections with the leg,
                from 0
            balance (str): how an arm's equilibrium is written: energy (default), or as published models
                have it: projected, collocated, closed_form; a path knows energy alone
            order (int): of the polynomials of an arm's strain, 0 to 9, without refinement; default as
                `accuracy` needs (docs/arm-models.md)
            elements (int): of each section (rod) or between two discs (subsegment_rod), without refinement;
                joints between two discs (prb); default as `order` or `accuracy` needs
            accuracy (number): of an arm's tip to which polynomials are refined, over its length, above 0
                and up to 1; default 1e-6. Without refinement give elements
            force_alone (bool): the wrench that is sensed has no moment; default true

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            pose: of the platform; in the plane x, y [m] and phi [rad], in space position (3,) [m] and
                quaternion (4,), w first
            legs: list of one record a leg: tensions (2,) [N], tendon_lengths (2,) [m], angles (joints,)
                [rad], chord_force [N], tip_wrench (3,) or (6,) [N, N m]
            wrench: (3,) in the plane, (6,) in space [N, N m], on the platform, about its reference point
            stiffness, compliance: (3, 3) or (6, 6): wrench [N, N m] by pose [m, rad], inputs held, and its
                inverse
            stable: bool, beside unstable_directions, an int
            potential: number [J]
            residual: number [m], of rods and chains without a unit: the largest error of what was solved
            iterations: int, of the solver

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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
        want: Sequence[str] | None = None,
        samples: int | None = None,
        following: Numbers | None = None,
        distributed: Numbers | None = None,
        distributed_following: Numbers | None = None,
        loads: Any | None = None,
        balance: str | None = None,
        order: int | None = None,
        elements: int | None = None,
        accuracy: Number | None = None,
        points: Any | None = None,
        steps: int | None = None,
        motions: Lists | None = None,
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

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            poses (list of poses) [m, rad]: the path, pose by pose
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs (numbers) [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of
                a rod its length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for
                n rows
            pose (pose) [m, rad]: of the platform, of a serial robot of its tip; of statics of legs of
                sections where it is held, or with `measured_tensions` was seen; in the plane x, y, phi, in
                space x, y, z and a quaternion, on the command line also a rotation vector
            independent (dict) [m]: in place of `pose` where hinges hold the platform in planes, or three
                rods hold it: height and two components of its quaternion; of hinges a mode, too, tilt or
                half_turn
            bending (numbers): sign of each leg's curvature; (legs,)
            elbow (numbers): side to which the strut of each leg turns, where the leg has a motor or a rail;
                (legs,)
            curvature (numbers) [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            angles (lists of numbers) [rad]: of the joints of each chain, from the first sprung one; before
                them the direction of a first link that a motor turns; a list each, or an array
            start (number, list, dict or str): where the search begins: a pose, of inverse and track inputs,
                of a serial robot its configuration, of an arm the mean curvatures and torsion of equal
                parts, as `all` tells them of each solution, of a platform on legs of sections a solution's
                pose and curvatures, or last, where the last question with a start ended, of `track` of an
                arm where its last path did, with what friction remembers; default the robot's home
            set_at (pose) [m, rad]: the pose at which the tendons are set without load, the outer ones loose
            hold (str): what stays after `set_at` or with `pose`: tension (default) or length
            tensions (lists of numbers) [N]: of both tendons of each leg; of an arm those of each section,
                of legs of sections those of leg 0 first, null for a tendon that `changes` has; a list each,
                or an array
            lengths (lists of numbers) [m]: of the tendon of each leg whose length is held; null, on the
                command line -, leaves the other one loose; (legs, 2)
            wrench (numbers) [N, N m]: force and moment on the platform, about its reference point, of an
                arm on its tip, in base axes; (3,) in the plane, (6,) in space
            gravity (numbers) [m/s^2]: of rods, arms and platforms that have a mass [m/s2]; default the
                file's; (3,)
            want (list of str): what is answered about the configuration: velocity, shape, stiffness,
                stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are
                added unless one of them is named
            samples (int): points of each backbone of a shape; poses on a path, default 60; points on a
                curve, at most, default 500
            following (numbers) [N, N m]: force and moment on an arm's tip, or on the platform on legs of
                sections, in its own axes, with which they turn; (3,) in the plane, (6,) in space
            distributed (numbers) [N/m]: force on all of an arm's backbone, or on those of all legs of
                sections, in base axes [N/m]; (3,)
            distributed_following (numbers) [N/m]: the same in the backbone's own axes [N/m]; in the plane x
                to its right and y along it; (3,)
            loads (number, list, dict or str): on an arm's backbone: a list of place, from the base along
                it, wrench and, where it turns with the place, following; on legs of sections with the leg,
                from 0
            balance (str): how an arm's equilibrium is written: energy (default), or as published models
                have it: projected, collocated, closed_form; a path knows energy alone
            order (int): of the polynomials of an arm's strain, 0 to 9, without refinement; default as
                `accuracy` needs (docs/arm-models.md)
            elements (int): of each section (rod) or between two discs (subsegment_rod), without refinement;
                joints between two discs (prb); default as `order` or `accuracy` needs
            accuracy (number): of an arm's tip to which polynomials are refined, over its length, above 0
                and up to 1; default 1e-6. Without refinement give elements
            points (number, list, dict or str): the path of an arm, whose tendons rub, or of a platform on
                legs of sections, whose tendons do not: a list of tensions or changes, as `forward` takes
                them, of such a platform also of a pose, and where they change wrench, following,
                distributed, distributed_following, loads, gravity
            steps (int): even ones to each point of an arm's path, a row each; default 10; finer ones tell
                more of what slips first
            motions (lists of numbers): of the tendons of each section of an arm in which direction, and how
                fast [N/s, m/s], what holds them goes on where the path ends: a change > 0 pays out, null
                rests. The answer has the rates there, with friction, as matrices; a list each, or an array
            from_ (number, list, dict or str) [m, rad]: first pose of a path, of rods with three inputs z,
                e1 and e2
            to (dict): last pose of a path; of a curve of equilibria what changes along it: inputs,
                tensions, lengths, wrench, pose
            objective (str): what redundant legs do with their freedom: limits, singularity, smooth or none
            rk4_steps (int): Runge-Kutta steps between poses; default the flow itself
            range (numbers): how far a curve goes: 0 is its beginning, 1 what it leads to; default [0, 1];
                (2,)
            backward (bool): a curve sets out the other way
            branches (bool): curves that leave it at bifurcations are followed, too

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            rows: list of one record a pose: pose, inputs (k,) [m, rad], curvature (legs,) [1/m],
                closure_error [m], indices
            curves: of a curve of equilibria, list of records with rows: parameter, pose, inputs (k,) [m,
                rad], stable, potential [J], event
            equilibria: of a curve, list of one record for each point where the parameter is 1: curve, row,
                pose, inputs (k,) [m, rad], stable
            residual: number [m], of rods and chains without a unit: the largest error of what was solved

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            section (int): which section, from 0
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            limit (number): how far to look `along` its direction; of a diagram the envelope's size
            changes (lists of numbers) [m]: of a serial robot or an arm the change of each tendon, > 0 pays
                out, section after section, of legs of sections leg after leg; a list each, or an array
            measured (number, list, dict or str) [m]: changes that encoders read, beside those commanded
            tolerance (number) [m]: of a tendon before it counts as slack or too short; default the file's
            envelope (str): bends that a section is allowed: square, disc or actuator; default its limit

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            class_, word, advice: str: exact, indeterminate, inconsistent or unreachable; the same for an
                operator
            slack: (tendons,) [m] at `point`, beside margin and over_tension, numbers [m]
            amount: number [m], what a tendon has too much or lacks; of an unreachable bend [rad]
            point: (2,) [rad], the bend that meets the tendons best: beta_1, beta_2, or theta cos phi, theta
                sin phi
            frontiers: list of records: half-planes normal (2,) and offset [rad], or curve
            polygon, boundary: (corners, 2) [rad]: what no tendon forbids, and that within the envelope
            area: number [rad^2], of the boundary

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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
        tensions: Lists | None = None,
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
        following: Numbers | None = None,
        distributed: Numbers | None = None,
        distributed_following: Numbers | None = None,
        loads: Any | None = None,
        balance: str | None = None,
        order: int | None = None,
        elements: int | None = None,
        accuracy: Number | None = None,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        path: str | None = None,
        threads: int | None = None,
        out: Any = None,
    ) -> Answer:
        """Polylines for a picture.

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            pose (pose) [m, rad]: of the platform, of a serial robot of its tip; of statics of legs of
                sections where it is held, or with `measured_tensions` was seen; in the plane x, y, phi, in
                space x, y, z and a quaternion, on the command line also a rotation vector
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            inputs (numbers) [m, rad]: in leg order: tendon_1 of each leg, of a leg on a rail its slide, of
                a rod its length; where the leg has a motor, theta, an angle, before it; (k,), or (n, k) for
                n rows
            independent (dict) [m]: in place of `pose` where hinges hold the platform in planes, or three
                rods hold it: height and two components of its quaternion; of hinges a mode, too, tilt or
                half_turn
            bending (numbers): sign of each leg's curvature; (legs,)
            elbow (numbers): side to which the strut of each leg turns, where the leg has a motor or a rail;
                (legs,)
            curvature (numbers) [1/m]: a curvature for each leg; the nearest solution is taken; (legs,)
            angles (lists of numbers) [rad]: of the joints of each chain, from the first sprung one; before
                them the direction of a first link that a motor turns; a list each, or an array
            start (number, list, dict or str): where the search begins: a pose, of inverse and track inputs,
                of a serial robot its configuration, of an arm the mean curvatures and torsion of equal
                parts, as `all` tells them of each solution, of a platform on legs of sections a solution's
                pose and curvatures, or last, where the last question with a start ended, of `track` of an
                arm where its last path did, with what friction remembers; default the robot's home
            tensions (lists of numbers) [N]: of both tendons of each leg; of an arm those of each section,
                of legs of sections those of leg 0 first, null for a tendon that `changes` has; a list each,
                or an array
            wrench (numbers) [N, N m]: force and moment on the platform, about its reference point, of an
                arm on its tip, in base axes; (3,) in the plane, (6,) in space
            gravity (numbers) [m/s^2]: of rods, arms and platforms that have a mass [m/s2]; default the
                file's; (3,)
            want (list of str): what is answered about the configuration: velocity, shape, stiffness,
                stability, margins, sensitivity, lines, as far as the robot has them; pose and legs are
                added unless one of them is named
            twist (numbers) [m/s, rad/s]: velocity and turning rate of the platform or the tip, in space
                three each, of rods with three inputs z, x and y of them alone, too; answers the rates of
                the inputs; with the want velocity; (3,) in the plane, (6,) in space
            rates (numbers) [m/s]: of the inputs, in place of `twist`; answers the twist of the platform;
                (k,), or (n, k) for n rows
            along (numbers) [m/s, rad/s]: a direction in which the nearest type II is looked for; with the
                want velocity; (3,) in the plane, (6,) in space
            limit (number): how far to look `along` its direction; of a diagram the envelope's size
            samples (int): points of each backbone of a shape; poses on a path, default 60; points on a
                curve, at most, default 500
            configuration (lists of numbers) [rad, m]: of a serial robot two angles a section: theta, phi of
                a neutral backbone, beta_1, beta_2 of twin pivots; and, where its length varies, its
                extension; sections not given are straight; a list each, or an array
            changes (lists of numbers) [m]: of a serial robot or an arm the change of each tendon, > 0 pays
                out, section after section, of legs of sections leg after leg; a list each, or an array
            following (numbers) [N, N m]: force and moment on an arm's tip, or on the platform on legs of
                sections, in its own axes, with which they turn; (3,) in the plane, (6,) in space
            distributed (numbers) [N/m]: force on all of an arm's backbone, or on those of all legs of
                sections, in base axes [N/m]; (3,)
            distributed_following (numbers) [N/m]: the same in the backbone's own axes [N/m]; in the plane x
                to its right and y along it; (3,)
            loads (number, list, dict or str): on an arm's backbone: a list of place, from the base along
                it, wrench and, where it turns with the place, following; on legs of sections with the leg,
                from 0
            balance (str): how an arm's equilibrium is written: energy (default), or as published models
                have it: projected, collocated, closed_form; a path knows energy alone
            order (int): of the polynomials of an arm's strain, 0 to 9, without refinement; default as
                `accuracy` needs (docs/arm-models.md)
            elements (int): of each section (rod) or between two discs (subsegment_rod), without refinement;
                joints between two discs (prb); default as `order` or `accuracy` needs
            accuracy (number): of an arm's tip to which polynomials are refined, over its length, above 0
                and up to 1; default 1e-6. Without refinement give elements

        An array of one dimension more than one value needs holds n rows; the answer is then `Columns`, of
        arrays (n, ...). Also by keyword, of n rows alone:
            outputs (dict or list of str): what comes out, as of `Robot.prepare`
            path (str): "continue", as of `Robot.prepare`
            threads (int): default all cores; the bytes do not depend on it
            out (dict of arrays): writable native doubles, (n, ...), of any strides, that become the
                answer's, by name

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            pose: of the platform; in the plane x, y [m] and phi [rad], in space position (3,) [m] and
                quaternion (4,), w first
            tip: of a serial robot instead of pose and legs: position (3,) [m] and quaternion (4,), w first
            backbones: (legs or sections, points, 2) in the plane, (..., 3) in space [m]
            tendons: (legs, 2, points, 2 or 3) [m]; a list each where their lengths differ
            lines: (legs, 2, 2 or 3) [m]: ends of the line through each leg
            platform, base: (points, 2 or 3) [m]: outlines
            frames: list of one pose at the tip of each leg
            residual: number [m], of rods and chains without a unit: the largest error of what was solved

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
        """

    def identify(
        self,
        rows: Rows | None = None,
        *,
        model: str | None = None,
        set: Mapping[str, Any] | None = None,
        theta_is: str | None = None,
        max_iterations: int | None = None,
        tilt: bool | None = None,
        fit: str | Sequence[str] | None = None,
        noise: Number | None = None,
        folds: int | None = None,
        map: bool | None = None,
        progress: Callable[[Record], Any] | bool | None = None,
    ) -> Identification:
        """Parameters of an arm, fitted to measured rows.

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            rows (dict of arrays, or a path): what was measured of an arm: pulls, a row each of what every
                motor draws in [m], markers, a row each of a marker's x, y, z [m], where known time [s], and
                blocks, whole numbers that rows of one motion share; or the text of a .csv table
                (docs/identify.md)
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only
            fit (str, or list of str): what may change, such as sections.bending,tendons.offset,marker;
                default what rows can usually tell (docs/identify.md)
            noise (number) [m]: of a coordinate of the marker; default what the fit leaves
            folds (int): in how many parts blocks of rows are held out in turn, and judged by a fit without
                them; default 5, 0 for none
            map (bool): motors and axes are taken as the rows say, should pulls be paid out, or tendons
                turned or the other way round

        Also by keyword:
            progress (function or bool): told, from a thread of its own, how far the fit is: a record of
                `part` (str), `steps` (int) of it and `error`, the root mean square distance so far [m];
                what it raises stops the fit and is raised. True: a line on stderr, the default where that
                is a terminal; False: nothing

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            robot: the fitted arm, a Robot; `asked` is that of the start, `file` its file as str, `save`
                writes it
            parameters: table with a record each: name, unit, start, value, deviation in that unit, at_bound
                (bool), prior_share
            errors: records before, fitted, held_out: rms, median, max, numbers [m], of distances between
                markers; rows and failed, int
            flat: list of records: deviation, a number of assumed deviations, and `along`, a str:
                combinations that the rows leave open
            by_row: arrays of each row: distance and held_out_distance (n,) [m], computed (n, 3) [m]
            covariance: (p, p), of coordinates: logarithms of factors, else differences in the parameters'
                units
            noise: number [m], of a coordinate of the marker
            map: record, where `map` took motors and axes as the rows say: sign, mirrored, turn [rad],
                agreement
            iterations: int, of the solver

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
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

        Numbers are SI and radians, or text with a unit; vectors are in base axes, the linear part before
        the angular.

        Fields, all by keyword but the first; which of them a robot takes, it says itself:
            set (dict): changes the robot for this question alone: values by their paths in its file, such
                as legs[0].link.length; on the command line it may be repeated
            model (str): how links are taken: cc (constant curvature) or prb (pseudo-rigid chains) of
                tendon-driven ones, rigid, rod (Kirchhoff); how the tendons of a serial robot are: pcc
                (exact) or lsk (linearised); how an arm's backbone is: rod, subsegment_rod (default),
                subsegment_cc, cc (of identify the default) or prb, and by pcc or lsk an arm is asked as a
                serial robot, without loads
            theta_is (str): what an input theta is the angle of: tangent (default) or chord
            law (str): how chains lump springs and tendons: M0w (default, ends weighted), M0 (the paper's),
                M1 (tendons straight between discs)
            max_iterations (int): most iterations of the solver; default 100, of arms 200 in each search, of
                legs of sections 2000, of rods 4000, of identify 60
            tilt (bool): poses of the answer have tilt, azimuth and torsion, too; in space only

        The answer has `ok`, `status`, `message`, and, as far as the robot has them:
            kind, space: str: parallel or serial, planar or spatial
            inputs, pose, configuration: lists of records: name, unit, and of tendons limits (2,) [m]
            home: pose where searches begin, in the plane x, y [m] and phi [rad], in space position (3,) [m]
                and quaternion (4,)
            legs, sections: lists of one record each: what the file says, lengths [m], angles [rad]
            models, model: list of str, str
            versions: record: sinew, a str; protocol, an int

        Raises `InputError` where a field is not to be read. No solution is no error: see `status`, `message`.
        """
