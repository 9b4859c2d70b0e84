function refused (part, call, id)
  % The call raises sinew:bad_input (or sinew:ID), with this part of a sentence.
  if nargin < 3
    id = 'bad_input';
  end
  try
    call ();
  catch thrown
    if ~ strcmp (thrown.identifier, ['sinew:', id])
      error ('%s: "%s", without the identifier sinew:%s', func2str (call), thrown.message, id);
    end
    if ~ isempty (part) && isempty (strfind (thrown.message, part))
      error ('the message is "%s", without "%s"', thrown.message, part);
    end
    return
  end
  error ('%s: nothing was refused (%s)', part, func2str (call));
end
