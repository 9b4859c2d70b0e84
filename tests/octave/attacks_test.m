% What is no question, and robots that are no more: a sentence, never a crash.
1;
r = sinew ('3pfs-g2');
ok = [0.44 0.42 0.41];

% Values.
refused ('inputs(1, 3) is NaN', @() r.forward ([0.44 0.42 NaN]));
refused ('is infinite', @() r.forward ([0.44 0.42 -Inf]));
refused ('max_iterations is NaN', @() r.forward (ok, 'max_iterations', NaN));
refused ('complex', @() r.forward (ok + 1i));
refused ('sparse', @() r.forward (sparse (ok)));
refused ('3 dimensions', @() r.forward (zeros (2, 3, 2)));
refused ('function_handle', @() r.forward (@sin));
refused ('function_handle', @() r.forward (ok, 'wrench', {@sin}));
refused ('a sinew;', @() r.forward (ok, 'wrench', r));
refused ('inputs', @() r.forward ([]));
refused ('inputs', @() r.forward ({}));
refused ('inputs', @() r.forward (0.44));
refused ('inputs', @() r.forward (ok(1:2)));
refused ('inputs', @() r.forward (true));
refused ('inputs', @() r.forward ('inputs', 'abc'));
refused ('missing key "inputs"', @() r.forward ());
refused ('rows of characters', @() r.forward (ok, 'model', ['rod'; 'abc']));
refused ('has no value', @() r.forward ('abc'));
refused ('last name has no value', @() r.forward (ok, 'wrench'));
refused ('name of a field should be', @() r.forward (ok, 3, 4));
refused ('name of a field should be', @() r.forward (ok, '', 4));
refused ('name of a field should be', @() r.forward (ok, {'wrench'}, 4));
refused ('wrench', @() r.forward (ok, 'wronch', 1:6));
refused ('twice', @() r.forward (ok, 'wrench', 1:6, 'wrench', 1:6));
refused ('', @() r.forward (ok, "a\0b", 1));
refused ('', @() r.forward (ok, char ([255 254 200]), 1));
refused ('UTF-8', @() r.forward (ok, 'model', char ([255 254 200])));
refused ('', @() r.forward (ok, 'model', repmat ('a', 1, 3e6)));
refused ('', @() r.forward (num2cell (zeros (1, 3e5))));
deep = 1;
for k = 1:5000
  deep = {deep};
end
refused ('nested deeper', @() r.forward (ok, 'wrench', deep));
refused ('query', @() r.ask (struct ()));
refused ('query', @() r.ask (3));
refused ('query', @() r.ask (struct ('query', {'forward', 'inverse'})));
refused ('', @() r.ask (struct ('query', 'nonsense')));
refused ('', @() r.ask (struct ('query', 3)));
refused ('JSON', @() r.ask ('{"query": '));
refused ('', @() r.ask (''));
refused ('', @() r.ask ("\0"));
refused ('', @() r.set ('legs[0].nothing', 1));
refused ('', @() r.set (3));
refused ('paths', @() r.set ('legs[0].length', @sin, 3));
refused ('function_handle', @() r.set ('legs[0].link.length', @sin));

% Robots.
refused ('there is no such file', @() sinew ('nope'));
refused ('there is no such file', @() sinew ('Grüße'));
refused ('a robot is a name', @() sinew (3));
refused ('a robot is a name', @() sinew ({}));
refused ('', @() sinew (''));
refused ('give a robot', @() sinew ());
refused ('missing key', @() sinew (struct ('sinew', 1)));
refused ('', @() sinew (struct ('sinew', {1, 2})));
refused ('', @() sinew (struct ()));
refused ('', @() sinew (sprintf ('legs:\n  - [')));
refused ('', @() sinew ('{'));
refused ('', @() sinew (repmat (sprintf ('a: b\n'), 1, 1e6)));

% Calls past the class.
for call = {{}, {'nothing'}, {3}, {'open'}, {'open', 3, 'text'}, {'open', 'x', 'struct'}, {'open', @sin, 'struct'}, ...
                 {'share'}, {'prepare'}, {'run', 1, {}, 0}, {'fields', 1}, {'ask', 1}, {'json', @sin, 'x'}, {@sin}}
  [value, id, message] = sinew_mex (call{1}{:});
  assert (isempty (value) && ~ isempty (id) && ~ isempty (message));
end
sinew_mex ('close', 12345);
sinew_mex ('close');
sinew_mex ('close', @sin);
try
  sinew_mex ('nothing');
  error ('nothing was refused');
catch thrown
  assert (thrown.identifier, 'sinew:bad_input');
end

% Robots that are closed, and a MEX file that goes away.
gone = sinew ('3-rfr');
b = gone.prepare ('inverse', 'pose', struct ('x', '$x', 'y', 0, 'phi', 0));
delete (gone);
refused ('closed', @() gone.forward ([0.19 0.19 0.188]), 'closed');
refused ('closed', @() sinew (gone), 'closed');
refused ('closed', @() gone.prepare ('inverse', 'pose', struct ('x', '$x', 'y', 0, 'phi', 0)), 'closed');
assert (b.run ([0; 0.01]).ok, [true; true]);  % it keeps the robot
delete (b);
delete (b);
refused ('closed', @() b.run (0), 'closed');
kept = r.forward (ok);
clear ('sinew_mex');
assert (mislocked ('sinew_mex'));
assert (isequal (r.forward (ok).pose, kept.pose));
munlock ('sinew_mex');
munlock ('sinew_mex');
munlock ('sinew_mex');
clear ('sinew_mex');
fresh = sinew ('3-rfr');
refused ('closed', @() r.forward (ok), 'closed');
assert (fresh.forward ([0.19 0.19 0.188]).ok);
delete (r);
clear all
printf ('attacks: fine\n');
