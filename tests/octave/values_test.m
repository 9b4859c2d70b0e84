% Numbers, texts and shapes on their way to the library and back.
1;

% Numbers read back to the same double: a robot's answer repeats its inputs.
r = sinew ('3pfs-g2');
rand ('seed', 3);
for k = 1:200
  inputs = 0.42 + 0.01 * rand (1, 3);
  assert (isequal (r.forward (inputs).inputs, inputs));
end

% A robot's text repeats what it is given; characters of all kinds come back.
for name = {'plain', 'with "quotes" and \ backslash', sprintf('tab\tend'), 'Grüße, 日本, 😀'}
  own = sinew (struct ('sinew', 1, 'name', name{1}, 'kind', 'serial', 'sections', ...
                       struct ('count', 2, 'type', 'neutral', 'segments', 3, 'joint', 0.002, ...
                               'disc', struct ('height', 0.002, 'radius', 0.003), ...
                               'tendons', struct ('count', 3, 'radius', 0.0025, 'angle', '24 deg each'))));
  assert (own.describe ().robot, name{1});
  assert (own.name, name{1});
end

% Shapes of answers.
a = r.forward ([0.44 0.42 0.41], 'want', {'stiffness', 'stability'});
assert (fieldnames (a)(1:3), {'ok'; 'status'; 'message'});
assert (islogical (a.ok) && a.ok && strcmp (a.status, 'converged') && isequal (a.message, ''));
assert (size (a.stiffness), [6 6]);
assert (size (a.pose.position), [1 3]);
assert (size (a.legs), [1 6]);
assert (islogical (a.stable) && isempty (a.unstable));
assert (size (vertcat (a.legs.force)), [6 3]);
v = r.velocity ([0.44 0.42 0.41]);
assert (size (v.K), [6 3]);
assert (v.J, a.stiffness, 1e-6 * max (abs (a.stiffness(:))));  % the stiffness at fixed lengths, rows first
assert (isequal (a.stiffness(1, 2), r.forward ([0.44 0.42 0.41], 'want', {'stiffness'}).stiffness(1, 2)));
s = r.shape ([0.44 0.42 0.41], 'samples', 5);
assert (iscell (s.backbones) && isequal (size (s.backbones{1}), [5 3]));
t = r.track ('from', struct ('z', 0.39, 'e1', 0, 'e2', 0), 'to', struct ('z', 0.4, 'e1', 0, 'e2', 0), 'samples', 3);
assert (size (t.rows), [1 3]);
assert (size (vertcat (t.rows.inputs)), [3 3]);

p = sinew ('3-rfr').track ('poses', struct ('x', {0, 0.01, 0.02}, 'y', 0, 'phi', 0));
assert (size (p.rows), [1 3]);
assert (isequal (sinew ('3-rfr').track ('poses', [p.rows.pose]).rows, p.rows));
assert (size (sinew ('3-rfr').track ('poses', p.rows(1).pose).rows), [1 1]);

% Lists of one, texts for lists, logicals, integers, singles, columns for rows.
assert (isfield (r.forward ([0.44 0.42 0.41], 'want', 'stiffness'), 'stiffness'));
assert (isfield (r.forward ([0.44 0.42 0.41], 'want', {'stiffness'}), 'stiffness'));
assert (isequal (r.forward ([0.44; 0.42; 0.41]).pose, a.pose));
assert (isequal (r.forward ({0.44, '420 mm', 0.41}).inputs, [0.44 0.42 0.41]));
assert (isequal (r.forward (single ([0.5 0.5 0.5])).inputs, [0.5 0.5 0.5]));
for kind = {'int8', 'uint8', 'int16', 'uint16', 'int32', 'uint32', 'int64', 'uint64', 'double'}
  limit = feval (kind{1}, 50);
  assert (r.forward ([0.44 0.42 0.41], 'max_iterations', limit).ok);
end
planar = sinew ('3-rfr');
b = planar.inverse (struct ('x', 0.01, 'y', 0, 'phi', 0), 'bending', int8 ([1 -1 1]));
assert (sign ([b.legs.curvature]), [1 -1 1]);
assert (planar.forward (b.inputs, 'all', true).count >= 1);

% NaN is a tendon of which nothing is given.
held = planar.statics ('lengths', [0.19 NaN; NaN 0.19; 0.188 NaN]);
assert (size (vertcat (held.legs.tensions)), [3 2]);

% Serial: rows are sections, or one row is the whole robot.
snake = sinew ('nottingham-tpcj');
one = snake.forward ([0.1 0.05]);
assert (one.configuration, [0.1 0.05; zeros(4, 2)]);
whole = snake.forward ([0.1 0.05, zeros(1, 8)]);
assert (isequal (whole.tip, one.tip));
assert (isequal (snake.forward ('changes', one.changes).ok, true));
assert (size (one.changes), [5 3]);
assert (snake.inverse (one.tip.position).ok);
assert (snake.diagram ('section', 0, 'changes', one.changes(1, :)).ok);

% An arm along a path: what slipped is remembered.
arm = sinew ('tendon-rod').set ('sections[0].tendons.friction', 0.3);
point = @(tension) struct ('tensions', {{[tension 0 0 0]}});
path = arm.track ('points', {point(3), point(1)}, 'steps', 4);
assert (path.ok);
assert (numel (path.rows), 8);
assert (path.tip.position(1) > arm.track ('points', {point(1)}).tip.position(1) + 1e-4);
assert (path.rows(4).end_tensions(1) < 3 && path.friction_loss > 0);

% An arm fitted to measured rows: a matrix of rows, also of one; the fitted arm answers.
measured = fullfile (fileparts (getenv ('SINEW_ROBOTS')), 'data', 'measured', 'ftdcr-v4.csv');
real = sinew ('ftdcr-v4');
fit = real.identify (measured, 'fit', {'bending', 'marker'}, 'folds', 0, 'max_iterations', 2);
assert (fit.rows, 810);
assert (numel (fit.parameters), 4);
assert (fit.errors.fitted.rms < fit.errors.before.rms);
assert (sinew (fit.file).forward ('changes', {[-2e-3 0 0]}, 'model', 'cc').ok);
same = real.identify (fileread (measured), 'fit', 'bending,marker', 'folds', 0, 'max_iterations', 2);
assert (same.errors.fitted.rms, fit.errors.fitted.rms);
one = struct ('pulls', [1e-3 zeros(1, 8)], 'markers', [0.02 0 0.2], 'time', 0, 'blocks', 0);
assert (real.identify (one, 'fit', 'bending', 'folds', 0).rows, 1);
two = struct ('pulls', [1e-3 zeros(1, 8); zeros(1, 9)], 'markers', [0.02 0 0.2; 0 0.01 0.2]);
assert (size (vertcat (real.identify (two, 'fit', 'bending').by_row.computed)), [2 3]);
refused ('cannot be read', @() real.identify ('no_such.csv'));
refused ('give the measured rows', @() real.identify ());
refused ('has 8 values', @() real.identify (setfield (one, 'pulls', zeros (1, 8))));
refused ('is NaN', @() real.identify (setfield (one, 'markers', [0 0 NaN])));

% From files, texts, structs; with other values.
here = fullfile (getenv ('SINEW_ROBOTS'), '3-rfr.yaml');
text = fileread (here);
assert (sinew (here).name, '3-RFR');
assert (isequal (sinew (text).forward (b.inputs).pose, sinew ('3-rfr').forward (b.inputs).pose));
longer = planar.set ('legs[0].link.length', 0.21, 'legs[1].link.length', '210 mm');
assert (longer.describe ().legs(1).link.length, 0.21);
assert (longer.describe ().legs(2).link.length, 0.21);
assert (planar.describe ().legs(1).link.length, 0.2);
nested.legs(2).link.length = 0.21;
assert ([planar.set(nested).describe().legs.link](2).length, 0.21);
assert ([planar.set(nested).describe().legs.link](1).length, 0.2);
assert ([planar.set(containers.Map ('legs[2].link.length', 0.22)).describe().legs.link](3).length, 0.22);
assert ([longer.set('legs[2].link.length', 0.22).describe().legs.link](1).length, 0.21);
assert ([planar.describe('set', nested).legs.link](2).length, 0.21);
assert (planar.ask ('{"query": "forward", "inputs": [0.19, 0.19, 0.188]}').ok);
assert (planar.ask (struct ('query', 'forward', 'inputs', [0.19 0.19 0.188])).ok);

% Arms: a row a section or one row; tensions come first; NaN where nothing is given.
arm = sinew ('two-segment');
a = arm.forward ([1 0 0; 0 1 0]);
assert (isequal (arm.forward ([1 0 0 0 1 0]).tip, a.tip));
assert (isequal (arm.forward ('tensions', [1 0 0; 0 1 0]).tip, a.tip));
assert (arm.forward ('tensions', [1 0 0 0 1 0; 2 0 0 0 1 0]).position(1, :), a.tip.position, 1e-12);
pulled = arm.forward ('changes', [-0.001 NaN NaN; 0 NaN NaN]);
assert (pulled.ok && pulled.changes(1, 1) == -0.001);
assert (arm.inverse ([0.05 0.03 0.38]).ok);
legs = sinew ('tripod-two-section');
assert (isequal (legs.forward (zeros (1, 18) + 0.1).pose, legs.forward (zeros (6, 3) + 0.1).pose));

% As it shows.
shown = evalc ('r');
assert (any (strfind (shown, 'sinew robot 3PFS-G2 (parallel)')));
assert (any (strcmp (completion_matches ('r.for'), 'r.forward')));
assert (any (strfind (help ('sinew'), 'r.forward')));
printf ('values: fine\n');
