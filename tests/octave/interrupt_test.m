% Ctrl-C ends what the library computes, at once, and what the user runs with it.
1;

function interrupted (what, call)
  % In a process of its own, which gets SIGINT after five seconds: a busy machine takes a while to start Octave.
  file = [tempname(), '.m'];
  handle = fopen (file, 'w');
  fprintf (handle, "r = sinew ('hexapod-torsion');\ntic\nunwind_protect\n  %s;\n  disp ('went on')\n", call);
  fprintf (handle, "unwind_protect_cleanup\n  printf ('ended after %%.2f s\\n', toc ())\nend\n");
  fclose (handle);
  command = sprintf ('timeout -k 40 -s INT 5 "%s/bin/octave-cli" --quiet --no-history --no-init-file --path "%s" "%s"', ...
                     OCTAVE_HOME (), fileparts (which ('sinew')), file);
  [~, said] = system (command);
  unlink (file);
  printf ('%s: %s', what, said);
  assert (isempty (strfind (said, 'went on')));
  assert (~ isempty (strfind (said, 'ended after')), 'it was killed: it did not end');
  assert (sscanf (said, 'ended after %f') < 30);  % to their end they take minutes
end

interrupted ('rows', 'r.forward (repmat (0.407 * ones (1, 6), 2000000, 1))');
% one takes about a second, which is more or less than that until the signal
interrupted ('a question', 'for k = 1:100, r.forward (0.407 * ones (1, 6), ''all'', true); end');
