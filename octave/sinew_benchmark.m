function sinew_benchmark ()
  % Prints what a call costs, beside the library alone, and how many rows a second a matrix is answered at.
  rod = sinew ('3pfs-g2');
  planar = sinew ('3-rfr');
  pose = struct ('x', 0.01, 'y', 0, 'phi', 0.1);
  fields = {'pose', pose};
  json = '{"query": "inverse", "pose": {"x": 0.01, "y": 0, "phi": 0.1}}';
  number = sinew.checked ('open', '3-rfr', 'file');
  one = planar.prepare ('inverse', 'pose', struct ('x', '$x', 'y', 0, 'phi', 0.1));

  nothing = time_of (@() sinew_mex ('close', 0), 5000);
  library = time_of (@() sinew_mex ('json', number, json), 3000) - nothing;
  fprintf ('an inverse of 3-RFR\n');
  fprintf ('  %-44s %8.1f us\n', 'the library, JSON to JSON', library);
  fprintf ('  %-44s %8.1f us\n', 'a call of the MEX file that does nothing', nothing);
  fprintf ('  %-44s %8.1f us\n', 'sinew_mex (''ask'', ...), arrays to a struct', ...
           time_of (@() sinew_mex ('ask', number, 'inverse', fields, {}), 3000));
  fprintf ('  %-44s %8.1f us\n', 'r.inverse (pose)', time_of (@() planar.inverse (pose), 3000));
  fprintf ('  %-44s %8.1f us\n', 'b.run (x), prepared, a row', time_of (@() one.run (0.01), 3000));
  sinew_mex ('close', number);

  rows = 200000;
  angle = 2 * pi * (1:rows).' / 1000;  % a walk of small steps
  lengths = 0.42 + 0.01 * [sin(angle), cos(angle), sin(2 * angle)];
  many = rod.prepare ('forward', 'inputs', '$L', 'path', 'continue');
  fprintf ('forward of 3PFS-G2, %d rows (%s)\n', rows, many.method);
  for threads = [1 0]
    tic;
    a = many.run (lengths, 'threads', threads);
    seconds = toc;
    name = {'all threads', 'one thread'};
    fprintf ('  %-44s %8.0f ns a row, %.2g rows/s\n', name{1 + threads}, 1e9 * seconds / rows, rows / seconds);
  end
  if ~ all (a.ok)
    fprintf ('  %d rows are not converged\n', sum (~ a.ok));
  end
end

function microseconds = time_of (call, count)
  % The shortest of five runs: others use the machine, too.
  microseconds = Inf;
  for run = 1:5
    tic;
    for k = 1:ceil (count / 5)
      call ();
    end
    microseconds = min (microseconds, 1e6 * toc / ceil (count / 5));
  end
end
