% The code of docs/octave.md, in order and in one workspace, prints what the page shows; `...` stands for anything.
% The line for MATLAB compiles the module here, too.
1;

function check_page (page)
  blocks = regexp (fileread (page), '```octave\n(.*?)```\n(?:```text\n(.*?)```\n)?', 'tokens');
  assert (numel (blocks) >= 6);
  for k = 1:numel (blocks)
    code = blocks{k}{1};
    assignin ('base', 'shown_code', code);
    printed = evalin ('base', 'evalc (shown_code)');
    shown = '';
    if numel (blocks{k}) > 1
      shown = blocks{k}{2};
    end
    pattern = strrep (regexptranslate ('escape', tidy (shown)), '\.\.\.', '.*?');
    if isempty (regexp (tidy (printed), ['^', pattern, '$'], 'once'))
      error ('%s\nprints\n%s\nnot\n%s', code, printed, shown);
    end
  end
end

function text = tidy (text)
  text = strtrim (regexprep (regexprep (text, '[ \t]+\n', "\n"), '\n+', "\n"));
end

function check_mex_line (page)
  line = regexp (fileread (page), '```matlab\n(.*?)```', 'tokens', 'once'){1};
  home = tempname ();
  mkdir (fullfile (home, 'sinew'));
  symlink (getenv ('SINEW_INCLUDE'), fullfile (home, 'sinew', 'include'));
  symlink (getenv ('SINEW_LIBRARY'), fullfile (home, 'sinew', 'lib'));
  copyfile (fullfile (getenv ('SINEW_DOCS'), '..', 'octave', '*.[chm]'), home);
  own = getenv ('HOME');
  here = cd (home);
  setenv ('HOME', home);
  eval (line);
  setenv ('HOME', own);
  asked = 'r = sinew (''3pfs-g2''); disp (r.forward ([0.44 0.42 0.41]).ok)';
  [~, said] = system (sprintf ('"%s/bin/octave-cli" --quiet --no-history --no-init-file --eval "%s"', OCTAVE_HOME (), asked));
  cd (here);
  confirm_recursive_rmdir (false, 'local');
  rmdir (home, 's');
  assert (strtrim (said), '1');
end

check_mex_line (fullfile (getenv ('SINEW_DOCS'), 'octave.md'));
check_page (fullfile (getenv ('SINEW_DOCS'), 'octave.md'));
printf ('page: fine\n');
