% A fit shows how far it is where errors go to a terminal, and only there.
1;

function said = shown (by)
  file = [tempname(), '.m'];
  handle = fopen (file, 'w');
  fprintf (handle, 'r = sinew (''ftdcr-v4'');\nk = (0:399)'';\n');
  fprintf (handle, 'rows.pulls = 1e-3 * sin (0.3 * k + (1:9));\nrows.markers = [2e-3 * sin(0.3 * k), 2e-3 * cos(0.2 * k), 0.19 + 0 * k];\n');
  fprintf (handle, 'a = r.identify (rows, ''fit'', ''bending,marker,base'', ''folds'', 5);\nprintf (''ended %%s\\n'', a.status)\n');
  fclose (handle);
  command = sprintf ('"%s/bin/octave-cli" --quiet --no-history --no-init-file --path "%s" "%s"', ...
                     OCTAVE_HOME (), fileparts (which ('sinew')), file);
  [~, said] = system (strrep (by, '%', command));
  unlink (file);
  assert (! isempty (strfind (said, 'ended ')), said);
end

assert (isempty (strfind (shown ('% 2>&1'), ', step ')));
if system ('command -v script > /dev/null') == 0
  said = shown ('script -qec ''%'' /dev/null');  % a terminal of its own
  assert (! isempty (regexp (said, ', step \d+, error [0-9.]+ mm')), said);
end
disp ('a terminal is told how far a fit is');
