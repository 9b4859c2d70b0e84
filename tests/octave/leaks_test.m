% A hundred thousand calls take no memory, also those that fail, and robots that come and go.
1;

function pages = memory ()
  pages = sscanf (fileread ('/proc/self/statm'), '%d')(2);
end

function calls (n)
  r = sinew_mex ('open', '3-rfr', 'file');
  fields = {'pose', struct('x', 0.01, 'y', 0, 'phi', 0.1)};
  for k = 1:n
    [~, ~, ~] = sinew_mex ('ask', r, 'inverse', fields, {});
  end
  sinew_mex ('close', r);
end

function methods (r, n)
  for k = 1:n
    r.inverse (struct ('x', 0.01, 'y', 0, 'phi', 0.1));
    r.inverse (struct ('x', [0 0.01], 'y', 0, 'phi', 0));
  end
end

function failures (r, n)
  for k = 1:n
    [~, ~, message] = sinew_mex ('ask_text', 3, 'x');
    try
      r.forward ({0.19, @sin});
    catch thrown
      assert (thrown.identifier, 'sinew:bad_input');
    end
    try
      r.forward ([0.19 0.19]);
    catch thrown
      assert (thrown.identifier, 'sinew:bad_input');
    end
  end
end

function robots (n)
  for k = 1:n
    r = sinew ('3-rfr');
    b = r.prepare ('inverse', 'pose', struct ('x', '$x', 'y', 0, 'phi', 0));
    b.run ([0; 0.01; 0.31]);
    r.inverse (struct ('x', [0 0.01], 'y', 0, 'phi', 0));
    r.set ('legs[0].link.length', 0.21);
  end
end

function check (what, once, n)
  once (round (n / 10));
  before = memory ();
  once (n);
  grown = (memory () - before) * 4096 / n;
  printf ('%s: %.1f bytes a call\n', what, grown);
  assert (grown * n < 1e6);
end

r = sinew ('3-rfr');
check ('calls', @calls, 100000);
check ('methods', @(n) methods (r, n), 3000);
check ('refusals', @(n) failures (r, n), 3000);
check ('robots', @robots, 300);
