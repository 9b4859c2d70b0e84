% Every robot and every query: what the methods answer, beside what `sinew query` prints. Questions are written to
% JSON by Octave's jsonencode and numbers are taken out of the answers by str2double, so that neither the writer
% nor the reader of the module is judged by itself.
1;

function found = numbers_of (value)
  % In the order of JSON: rows first.
  if isnumeric (value) || islogical (value)
    found = double (value.'(:)).';
  elseif iscell (value)
    found = cellfun (@numbers_of, value(:).', 'UniformOutput', false);
    found = [found{:}];
  elseif isstruct (value)
    found = [];
    for k = 1:numel (value)
      found = [found, numbers_of(struct2cell (value(k)).')];
    end
  else
    found = [];
  end
end

function found = texts_of (value)
  found = {};
  if ischar (value)
    found = {value};
  elseif iscell (value)
    found = cellfun (@texts_of, value(:).', 'UniformOutput', false);
    found = [found{:}];
  elseif isstruct (value)
    for k = 1:numel (value)
      found = [found, texts_of(struct2cell (value(k)).')];
    end
  end
end

function [numbers, texts] = leaves_of_json (json)
  [quoted, bare] = regexp (json, '"((?:[^"\\]|\\.)*)"(:?)', 'tokens', 'split');
  is_text = cellfun (@(t) isempty (t{2}), quoted);
  texts = cellfun (@(t) do_string_escapes (t{1}), quoted(is_text), 'UniformOutput', false);
  bare = strrep (strrep (strjoin (bare, ' '), 'true', '1'), 'false', '0');
  numbers = str2double (regexp (bare, '-?\d[-+.eE\d]*', 'match'));
end

function compare (robot, json, asked, line)
  [numbers, texts] = leaves_of_json (line);
  if any (strcmp (texts, 'file_missing'))
    error ('%s: %s', json, line);
  end
  what = sprintf ('%s %s', robot, json);
  rest = rmfield (asked, 'ok');
  if isempty (rest.message)
    rest = rmfield (rest, 'message');
  end
  ours = numbers_of (rest);
  if ~ isequal (ours(:), numbers(:)) && ~ isequal (sort (ours(:)), sort (numbers(:)))  % rows with fields that others lack
    error ('%s: other numbers than %s', what, line);
  end
  if ~ isequal (sort (texts_of (rest)), sort (texts))
    error ('%s: other texts than %s', what, line);
  end
  assert (asked.ok, strcmp (asked.status, 'converged'));
end

function questions = questions_of (r)
  % Of each query one or more, as structs; without single-element lists, which jsonencode would not write as lists.
  ask = @(query, varargin) struct ('query', query, varargin{:});
  d = r.describe ();
  if strcmp (d.kind, 'serial')
    bends = [0.1 0.2; 0.2 -0.1; 0.05 0.1](1:min (3, numel (d.sections)), :);
    f = r.forward (bends);
    questions = {ask('forward', 'configuration', bends), ask('forward', 'changes', f.changes), ...
                 ask('inverse', 'position', f.tip.position), ask('inverse', 'pose', f.tip), ...
                 ask('velocity', 'configuration', bends, 'twist', [1 2 3 4 5 6] * 1e-3), ...
                 ask('shape', 'configuration', bends, 'samples', 3), ...
                 ask('diagram', 'section', 0, 'changes', f.changes(1, :), 'limit', 1), ...
                 ask('diagram', 'section', 1, 'changes', f.changes(1:2, :), 'model', 'pcc', 'limit', 1), ...
                 ask('track', 'from', f.tip, 'to', f.tip), ask('statics')};
    return
  end
  if strcmp (d.kind, 'arm')
    f = r.forward ('changes', []);
    tip = round (f.tip.position * 1e6) * 1e-6;  % jsonencode writes 1e-19 as 0
    questions = {ask('forward', 'changes', []), ask('inverse', 'position', tip), ask('shape', 'changes', []), ...
                 ask('velocity', 'changes', []), ask('track', 'from', f.tip, 'to', f.tip), ...
                 ask('track', 'points', {struct('changes', {{}})}, 'steps', 2), ask('statics'), ask('diagram')};
    return
  end
  if strcmp (d.kind, 'arm_legs')
    f = r.forward ('changes', []);
    if isfield (f.pose, 'x'), place = [f.pose.x f.pose.y]; else, place = f.pose.position; end
    place = round (place * 1e6) * 1e-6;
    questions = {ask('forward', 'changes', []), ask('inverse', 'position', place), ask('shape', 'changes', [], 'samples', 3), ...
                 ask('velocity', 'changes', []), ask('track', 'from', f.pose, 'to', f.pose), ...
                 ask('track', 'points', {struct('changes', {{}})}, 'steps', 2), ask('statics'), ask('diagram')};
    return
  end
  if isfield (d.home, 'x')
    pose = d.home;  beyond = setfield (pose, 'x', pose.x + 0.001);  wrench = [0.01 -0.02 0.001];
  else
    pose = struct ('position', d.home.position, 'quaternion', d.home.quaternion);
    beyond = setfield (pose, 'position', pose.position + [0 0 0.002]);
    wrench = [0.1 0 -0.2 0 0.01 0];
  end
  if numel (d.inputs) == 3 && any (ismember (d.models, {'rod', 'rigid'}))
    pose = struct ('z', d.home.position(3), 'e1', 0, 'e2', 0.05);
    beyond = setfield (pose, 'e1', 0.02);
    questions = {ask('inverse', 'independent', pose), ask('velocity', 'independent', pose)};
    i = r.inverse ('independent', pose);
  else
    questions = {ask('inverse', 'pose', pose), ask('inverse', 'pose', beyond), ask('velocity', 'pose', pose), ...
                 ask('shape', 'pose', pose, 'samples', 4)};
    i = r.inverse (beyond);
  end
  if isfield (i, 'inputs')
    questions = [questions, {ask('forward', 'inputs', i.inputs), ask('statics', 'inputs', i.inputs, 'axial_forces', 0.01 * (1:6)), ...
                             ask('shape', 'inputs', i.inputs, 'samples', 2), ask('velocity', 'inputs', i.inputs)}];
  end
  if numel (d.inputs) == 3  % of six rods that bear torque it takes seconds
    questions{end+1} = ask ('forward', 'inputs', i.inputs, 'all', true);
  end
  if any (strcmp (d.models, 'rigid'))  % its path is of whole poses
    pose = i.pose;
    beyond = i.pose;
  end
  if isfield (pose, 'position')
    questions{end+1} = ask ('velocity', 'pose', pose, 'tilt', true);
  end
  questions = [questions, {ask('track', 'from', pose, 'to', beyond, 'samples', 3), ask('diagram', 'section', 0), ...
                           ask('statics', 'set_at', pose, 'wrench', wrench)}];
end

function ask_all (robot, command)
  r = sinew (robot);
  questions = [{struct('query', 'describe')}, questions_of(r)];
  json = cellfun (@jsonencode, questions, 'UniformOutput', false);
  file = tempname ();
  write (file, strjoin (json, "\n"));
  [code, printed] = system (sprintf ('"%s" query "%s" < "%s"', command, robot, file));
  unlink (file);
  assert (code, 0);
  lines = strsplit (strtrim (printed), "\n");
  assert (numel (lines), numel (json));
  for k = 1:numel (json)
    try
      asked = r.ask (questions{k});
    catch thrown  % the same refusal
      assert (thrown.identifier, 'sinew:bad_input');
      [~, texts] = leaves_of_json (lines{k});
      if ~ any (strcmp (texts, thrown.message))
        error ('%s %s: "%s", not %s', robot, json{k}, thrown.message, lines{k});
      end
      continue
    end
    compare (robot, json{k}, asked, lines{k});
  end
  queries = unique (cellfun (@(q) q.query, questions, 'UniformOutput', false));
  assert (numel (queries), 8);
end

function write (file, text)
  handle = fopen (file, 'w');
  fputs (handle, text);
  fclose (handle);
end

robots = glob (fullfile (getenv ('SINEW_ROBOTS'), '*.yaml'));
assert (numel (robots) > 15);
for k = 1:numel (robots)
  ask_all (robots{k}, getenv ('SINEW_COMMAND'));
end
printf ('%d robots\n', numel (robots));
