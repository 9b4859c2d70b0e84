% Matrices with a row a configuration.
1;
r = sinew ('3pfs-g2');
rand ('seed', 5);
n = 40;
L = 0.42 + 0.02 * rand (n, 3);

% Columns are the answers of the rows, which a session of its own may differ from in the last digits.
c = r.forward (L);
assert (size (c.position), [n 3]);
assert (size (c.quaternion), [n 4]);
assert (islogical (c.ok) && isequal (size (c.ok), [n 1]) && all (c.ok));
assert (isa (c.status, 'uint8') && isequal (sinew.status_names (c.status(1:2)), {'converged'; 'converged'}));
for k = [1 7 n]
  a = r.forward (L(k, :));
  assert (c.position(k, :), a.pose.position, 1e-12);
  assert (c.quaternion(k, :), a.pose.quaternion, 1e-12);
end

% The same bytes for any number of threads, of other classes, and of views that are copies.
assert (isequal (r.forward (L, 'threads', 1), r.forward (L, 'threads', 2)));
assert (isequal (r.forward (single (L)), r.forward (double (single (L)))));
big = rand (n, 9) * 0.001 + 0.42;
assert (isequal (r.forward (big(:, 4:6)).position, r.forward (big(:, [4 5 6])).position));

% A load for each row, or one for all.
W = [zeros(n, 2), -linspace(0, 5, n).', zeros(n, 3)];
d = r.forward (L, 'wrench', W);
assert (d.position(n, :), r.forward (L(n, :), 'wrench', W(n, :)).pose.position, 1e-12);
e = r.forward (L, 'wrench', W(n, :));
assert (e.position(n, :), d.position(n, :), 1e-12);
f = r.forward (L(1, :), 'wrench', W);
assert (f.position(n, :), r.forward (L(1, :), 'wrench', W(n, :)).pose.position, 1e-12);

% Columns of poses.
planar = sinew ('3-rfr');
x = linspace (-0.02, 0.02, 9);
p = planar.inverse (struct ('x', x, 'y', 0, 'phi', 0.1));
assert (size (p.inputs), [9 3]);
assert (p.inputs(3, :), planar.inverse (struct ('x', x(3), 'y', 0, 'phi', 0.1)).inputs, 1e-14);
hexapod = sinew ('hexapod');
home = hexapod.describe ().home;
P = home.position + [zeros(3, 2), [0; 0.001; 0.002]];
h = hexapod.inverse (struct ('position', P, 'quaternion', home.quaternion));
assert (size (h.inputs), [3 6]);
assert (h.inputs(2, :), hexapod.inverse (struct ('position', P(2, :))).inputs, 1e-9);

% Outputs of one's own; matrices of a row are pages across.
m = r.velocity (L, 'outputs', {'J', 'legs[0].force', 'pose.position[2]'});
assert (size (m.J), [n 6 6]);
assert (size (m.legs_0_force), [n 3]);
assert (size (m.pose_position_2), [n 1]);
v = r.velocity (L(4, :));
assert (squeeze (m.J(4, :, :)), v.J, 1e-6);
assert (r.forward (L, 'outputs', struct ('z', 'pose.position[2]')).z, c.position(:, 3));
k = r.velocity (L, 'outputs', {'K'}).K;
assert (squeeze (k(4, :, :)), v.K, 1e-6);

assert (size (r.forward (L, 'outputs', struct ('ok', 'pose.position[2]')).ok), [n 1]);  % what was asked for

% A batch of one and of none.
assert (size (r.forward (L(1, :), 'threads', 1).position), [1 3]);
assert (size (r.forward (zeros (0, 3)).position), [0 3]);
assert (size (r.forward (zeros (0, 3)).ok), [0 1]);

% Rows without a solution are rows; rows that are no question say so.
bad = r.forward ([L(1, :); NaN 0.4 0.4; 0.4 Inf 0.4; L(2, :)]);
assert (bad.ok, [true; false; false; true]);
assert (sinew.status_names (bad.status(2)), {'bad_input'});
assert (all (isnan (bad.position(2, :))) && ~ isempty (bad.message));
far = planar.inverse (struct ('x', [0 0.31], 'y', 0, 'phi', 0));
assert (sinew.status_names (far.status), {'converged'; 'unreachable'});

% Serial robots: a row has all sections.
snake = sinew ('nottingham-neutral');
C = 0.1 * rand (6, 10);
s = snake.forward (C);
assert (s.position(5, :), snake.forward (C(5, :)).tip.position, 1e-15);
assert (size (s.changes), [6 15]);
back = snake.forward ('changes', s.changes);
assert (back.position, s.position, 1e-9);
i = snake.inverse (s.position);
assert (size (i.configuration), [6 5 2]);
assert (isequal (snake.forward (i.configuration), snake.forward (reshape (permute (i.configuration, [1 3 2]), 6, 10))));
pulled = planar.statics ('tensions', cat (3, 0.2 * ones (4, 3), 0.1 * ones (4, 3)), 'outputs', {'pose.x'});
assert (pulled.pose_x(4), planar.statics ('tensions', [0.2 0.1; 0.2 0.1; 0.2 0.1]).pose.x, 1e-12);

% Prepared.
b = r.prepare ('forward', 'inputs', '$L', 'wrench', '$W', 'outputs', {'pose.position'}, 'path', 'continue');
assert ({b.inputs.name}, {'L', 'W'});
assert (b.inputs(1).shape, 3);
assert (b.outputs(1).unit, 'm');
q = b.run (L, W);
assert (q.pose_position, d.position, 1e-9);
assert (isequal (b.run (L, W, 'threads', 1), b.run (L, W, 'threads', 2)));
one = r.prepare ('forward', 'inputs', {'$a', 0.42, 0.41});
assert (one.run ([0.44; 0.43]).position(1, :), r.forward ([0.44 0.42 0.41]).pose.position, 1e-12);
assert (isequal (one.run ([0.44 0.43]), one.run ([0.44; 0.43])));
set = planar.set ('legs[0].link.length', 0.21);
assert (set.inverse (struct ('x', x, 'y', 0, 'phi', 0)).inputs(3, :), ...
        set.inverse (struct ('x', x(3), 'y', 0, 'phi', 0)).inputs, 1e-14);

refused ('has 2 columns, a row has 3 numbers', @() r.forward (L(:, 1:2)));
refused ('give one row, or as many', @() r.forward (L, 'wrench', W(1:5, :)));
refused ('give as many', @() b.run (L, W(1:5, :)));
refused ('1 arrays were given for 2 fields', @() b.run (L));
refused ('W is a cell', @() b.run (L, {}));
refused ('complex', @() b.run (L, W * 1i));
refused ('sparse', @() b.run (sparse (L), W));
refused ('char', @() b.run ('abc', W));
refused ('threads', @() b.run (L, W, 'threads', -1));
refused ('threads', @() r.forward (L, 'threads', 1.5));
refused ('outputs', @() r.forward (L, 'outputs', {3}));
refused ('pose_nothing', @() r.forward (L, 'outputs', {'pose.nothing'}));
refused ('one by one', @() r.forward (L, 'all', true));
stiff = r.forward (L, 'want', {'stiffness'});
assert (size (stiff.stiffness), [n 6 6]);
assert (max (max (max (abs (stiff.stiffness - r.forward (L, 'outputs', {'stiffness'}).stiffness)))) == 0);
refused ('', @() r.prepare ('forward', 'inputs', [0.44 0.42 0.41]));
printf ('arrays: fine\n');
